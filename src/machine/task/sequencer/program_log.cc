// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/program_log.hh"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstring>
#include <deque>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/thread_priority.hh"

namespace mw::task {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t MOST_WAITING = 1U << 20U;  // [bytes]
constexpr std::chrono::seconds LATE{1};
constexpr std::chrono::milliseconds LONGEST_END{500};

}  // namespace

Result<int> LogDisk::open(const std::string &path, bool appending, const Confinement *confinement) {
    const int how = O_WRONLY | O_CREAT | (appending ? O_APPEND : O_TRUNC);
    return confinement != nullptr ? open_log(*confinement, path, appending) : open_regular_file(path, how);
}

Result<> LogDisk::write(int file, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno != EINTR) {
            return fail(std::strerror(errno));
        }
        text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
    }
    return {};
}

Result<> LogDisk::close(int file) {
    return ::close(file) == 0 || errno == EINTR ? Result<>{} : fail(std::strerror(errno));
}

struct ProgramLog::Job {
    enum class Kind : std::uint8_t { OPEN, LINE, CLOSE };
    Kind kind = Kind::CLOSE;
    std::string text;  ///< a line, or a path
    bool appending = false;
    std::optional<Confinement> confinement{};
    std::size_t size() const { return text.size() + sizeof(Job); }
};

struct ProgramLog::Shared {
    explicit Shared(std::shared_ptr<LogDisk> disk_of_files) : disk(std::move(disk_of_files)) {}

    mutable std::mutex mutex;
    std::condition_variable asked, done;
    // Guarded by the mutex, which is not held during disk access.
    std::deque<Job> jobs;
    std::size_t bytes = 0;           ///< total of pending jobs
    Clock::time_point busy_since{};  ///< start of the current disk access
    bool isBusy = false, ending = false, isOver = false, late_reported = false;
    std::optional<Result<>> opened;  ///< result of the last open
    std::optional<Error> failure;
    // Used by the working thread.
    std::shared_ptr<LogDisk> disk;
    std::string path;
    int file = -1;

    void note(const Result<> &result) {
        const std::lock_guard lock(mutex);
        if (!result.has_value() && !failure.has_value()) {
            failure = Error{fmt::format("cannot write {}: {}", path, result.error().message), {}, {}};
        }
    }
    void close_file() {
        if (file >= 0) {
            note(disk->close(std::exchange(file, -1)));
        }
    }
    void open_file(const Job &job) {
        close_file();
        path = job.text;
        const auto result =
            disk->open(path, job.appending, job.confinement.has_value() ? &*job.confinement : nullptr);
        file = result.value_or(-1);
        const std::lock_guard lock(mutex);
        opened = result.has_value() ? Result<>{} : std::unexpected(result.error());
    }
    void write_lines(const std::string &text) {
        if (file < 0) {
            return;
        }
        if (const auto written = disk->write(file, text); !written.has_value()) {
            note(written);
            close_file();
        }
    }
    bool isLate() const { return isBusy && Clock::now() - busy_since > LATE; }
};

ProgramLog::ProgramLog(LogWorks works, std::shared_ptr<LogDisk> disk)
    : works_(works), shared_(std::make_shared<Shared>(std::move(disk))) {}

ProgramLog::~ProgramLog() {
    close();
    if (!thread_.joinable()) {
        work(*shared_);
        return;
    }
    std::unique_lock lock(shared_->mutex);
    shared_->ending = true;
    shared_->asked.notify_one();
    if (shared_->done.wait_for(lock, LONGEST_END, [this] { return shared_->isOver; })) {
        lock.unlock();
        thread_.join();
        return;
    }
    lock.unlock();
    thread_.detach();  // the thread shares ownership of its data
    std::fputs(fmt::format("{} is incomplete: its disk does not respond\n", path_).c_str(), stderr);
}

/// Executes the jobs. Consecutive lines are written together.
void ProgramLog::work(Shared &shared) {
    std::unique_lock lock(shared.mutex);
    while (!shared.jobs.empty()) {
        const Job job = std::move(shared.jobs.front());
        shared.jobs.pop_front();
        std::size_t size = job.size();
        std::string lines = job.kind == Job::Kind::LINE ? job.text : "";
        while (job.kind == Job::Kind::LINE && !shared.jobs.empty() &&
               shared.jobs.front().kind == Job::Kind::LINE) {
            lines += shared.jobs.front().text;
            size += shared.jobs.front().size();
            shared.jobs.pop_front();
        }
        shared.isBusy = true;
        shared.busy_since = Clock::now();
        lock.unlock();
        switch (job.kind) {
        case Job::Kind::OPEN: shared.open_file(job); break;
        case Job::Kind::LINE: shared.write_lines(lines); break;
        case Job::Kind::CLOSE: shared.close_file(); break;
        }
        lock.lock();
        shared.isBusy = shared.late_reported = false;
        shared.bytes -= size;
    }
}

void ProgramLog::run_thread(const std::shared_ptr<Shared> &shared) {
    raise_priority();  // raised because the program waits for the result of opening a file
    while (true) {
        work(*shared);
        std::unique_lock lock(shared->mutex);
        if (shared->jobs.empty() && shared->ending) {
            shared->isOver = true;
            shared->done.notify_all();
            return;
        }
        shared->asked.wait(lock, [&shared] { return !shared->jobs.empty() || shared->ending; });
    }
}

void ProgramLog::ask(Job job) {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->bytes += job.size();
        shared_->jobs.push_back(std::move(job));
    }
    if (works_ == LogWorks::ON_CALL) {
        work(*shared_);
        return;
    }
    if (!thread_.joinable()) {
        thread_ = std::thread([shared = shared_] { run_thread(shared); });
    }
    shared_->asked.notify_one();
}

void ProgramLog::open(const std::string &path, bool appending, const Confinement *confinement) {
    close();
    path_ = path;
    open_ = true;
    Job job{Job::Kind::OPEN, path, appending};
    if (confinement != nullptr) {
        job.confinement = *confinement;
    }
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->opened.reset();
        if (shared_->bytes > MOST_WAITING) {
            shared_->opened = fail("cannot write " + path + ": too much waits for the disk");
            return;
        }
    }
    ask(std::move(job));
}

std::optional<Result<>> ProgramLog::opened() const {
    const std::lock_guard lock(shared_->mutex);
    return shared_->opened;
}

Result<> ProgramLog::write(const std::string &line) {
    if (!open_) {
        return {};
    }
    {
        const std::lock_guard lock(shared_->mutex);
        open_ = shared_->bytes + line.size() <= MOST_WAITING;
    }
    if (!open_) {
        ask({Job::Kind::CLOSE, ""});
        return fail(fmt::format("cannot write {}: the disk is too slow, or does not answer", path_));
    }
    ask({Job::Kind::LINE, line + '\n'});
    return {};
}

void ProgramLog::close() {
    if (!std::exchange(open_, false)) {
        return;
    }
    {
        const std::lock_guard lock(shared_->mutex);
        auto &jobs = shared_->jobs;
        if (!jobs.empty() && jobs.back().kind == Job::Kind::OPEN) {
            shared_->bytes -= jobs.back().size();
            jobs.pop_back();
            return;
        }
    }
    ask({Job::Kind::CLOSE, ""});
}

std::optional<Error> ProgramLog::take_failure() {
    const std::lock_guard lock(shared_->mutex);
    return std::exchange(shared_->failure, std::nullopt);
}

std::optional<std::string> ProgramLog::take_delay() {
    const std::lock_guard lock(shared_->mutex);
    if (!shared_->isLate() || std::exchange(shared_->late_reported, true)) {
        return std::nullopt;
    }
    return fmt::format("the disk of {} has not answered for 1 s", path_);
}

bool ProgramLog::isSettled() const {
    const std::lock_guard lock(shared_->mutex);
    return !shared_->failure.has_value() && (shared_->bytes == 0 || shared_->isLate());
}

}  // namespace mw::task
