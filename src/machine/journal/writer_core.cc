// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/journal/writer_core.hh"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace mw::journal {
namespace {

/// Size of records after which a journal is replaced by a short one.
constexpr std::uint64_t MOST_RECORD_BYTES = 1U << 20U;
/// Duration above which the disk is too slow, so that the journal lags behind the tool.
constexpr double SLOW_S = 0.8;
constexpr std::int64_t NS_PER_S = 1000000000;
constexpr std::int64_t LATE_NS = NS_PER_S;

constexpr auto is_progress = [](const auto &job) {
    return job.kind == std::remove_cvref_t<decltype(job)>::Kind::PROGRESS;
};

std::string whole(const Run &run) {
    const std::uint64_t key = key_of(run.start);
    std::string bytes = begin_bytes(run.start);
    bytes += run.doubt.has_value() ? record(key, *run.doubt) : "";
    bytes += run.progress.has_value() ? record(key, *run.progress) : "";
    bytes += run.ended ? end_record(key) : "";
    return bytes;
}

std::string why_not(Disk &disk, const Start &start) {
    if (!disk.exists(start.program)) {
        return "its file no longer exists";
    }
    const auto content = disk.read(start.program);
    if (!content.has_value()) {
        return content.error().message;
    }
    return mark_of(*content) == start.file ? "" : "its file has changed since the program was started";
}

}  // namespace

void Writer::Core::find() {
    if (path_.empty() || !disk_->exists(path_)) {
        return;
    }
    const auto bytes = disk_->read(path_);
    auto run = bytes.has_value() ? read_run(*bytes) : std::unexpected(bytes.error());
    if (!run.has_value()) {
        troubles_.push_back(path_ + ": " + run.error().message +
                            ": an interrupted program cannot be continued");
    } else if (!run->ended && run->progress.has_value()) {
        found_.refusal = why_not(*disk_, run->start);
        found_.run = std::move(*run);
    }
}

void Writer::Core::ask(Job job) {
    {
        const std::lock_guard lock(mutex_);
        job.number = ++last_job_;
        if (job.kind == Job::Kind::BEGIN || job.kind == Job::Kind::FORGET) {  // earlier jobs have no effect
            std::erase_if(jobs_, [](const Job &one) {
                return one.kind != Job::Kind::FILE && one.kind != Job::Kind::READ;
            });
        }
        if (job.kind == Job::Kind::FILE) {
            files_[job.path].asked = job.number;
        }
        const auto same = std::ranges::find_if(jobs_, [&](const Job &one) {
            return one.kind == job.kind &&
                   (job.kind == Job::Kind::FILE ? one.path == job.path
                                                : job.kind == Job::Kind::PROGRESS && &one == &jobs_.back());
        });
        if (same != jobs_.end()) {
            *same = std::move(job);
        } else {
            jobs_.push_back(std::move(job));
        }
    }
    asked_.notify_one();
}

bool Writer::Core::isSettled(const std::string &path) const {
    const std::lock_guard lock(mutex_);
    const auto file = files_.find(path);
    return late_ || file == files_.end() || file->second.done == file->second.asked;
}

Result<> Writer::Core::wait_for(const std::string &path, std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    const FileState &file = files_[path];
    done_.wait_for(lock, longest, [&] { return file.done == file.asked || late_; });
    if (file.done != file.asked) {
        return fail(fmt::format("the disk of {} has not answered for 1 s", path));
    }
    return file.failure.has_value() ? std::unexpected(*file.failure) : Result<>{};
}

bool Writer::Core::end_thread(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    ending_ = true;
    asked_.notify_one();
    return done_.wait_for(lock, longest, [this] { return ended_; });
}

std::vector<std::string> Writer::Core::unwritten() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> reasons;
    for (const auto &[path, file] : files_) {
        if (file.done != file.asked) {
            reasons.push_back(fmt::format("{} is not written: its disk does not answer", path));
        } else if (file.failure.has_value()) {
            reasons.push_back(fmt::format("{} is not written: {}", path, file.failure->message));
        }
    }
    return reasons;
}

void Writer::Core::run_thread() {
    while (true) {
        {
            std::unique_lock lock(mutex_);
            asked_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
            if (jobs_.empty()) {
                break;
            }
        }
        const auto began = std::chrono::steady_clock::now();
        work();
        const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        if (took_s > SLOW_S && isBehind()) {
            tell(
                fail("the disk was slow: after a power cut the program would continue from an earlier line"));
        }
    }
    write_failed();
    const std::lock_guard lock(mutex_);
    ended_ = true;
    done_.notify_all();
}

bool Writer::Core::work() {
    Jobs jobs;
    {
        const std::lock_guard lock(mutex_);
        jobs.swap(jobs_);
    }
    hadProgress_ = std::ranges::any_of(jobs, is_progress);
    do_jobs(jobs);
    return !jobs.empty();
}

/// True if the last jobs have stored progress of the program.
bool Writer::Core::isBehind() const {
    const std::lock_guard lock(mutex_);
    return isJournalled() && (hadProgress_ || std::ranges::any_of(jobs_, is_progress));
}

std::optional<std::string> Writer::Core::take_trouble() {
    const std::lock_guard lock(mutex_);
    if (troubles_.empty()) {
        return std::nullopt;
    }
    std::string first = std::move(troubles_.front());
    troubles_.pop_front();
    return first;
}

std::optional<std::string> Writer::Core::take_delay(std::int64_t now_ns) {
    const std::lock_guard lock(mutex_);
    if (busy_job_ != watched_job_) {
        watched_job_ = busy_job_;
        watched_since_ns_ = now_ns;
    }
    if (watched_job_ == 0 || late_ || now_ns - watched_since_ns_ < LATE_NS) {
        return std::nullopt;
    }
    late_ = true;
    return fmt::format("the disk of {} has not answered for 1 s", busy_path_);
}

void Writer::Core::set_busy(std::uint64_t number, const std::string &path) {
    const std::lock_guard lock(mutex_);
    busy_job_ = number;
    busy_path_ = path;
    late_ = false;
}

/// Reports errors; continues with the next job after an error.
void Writer::Core::do_jobs(Jobs &jobs) {
    for (Job &job : jobs) {
        set_busy(job.number, job.path.empty() ? path_ : job.path);
        const auto done = do_job(job);
        if (!done.has_value()) {
            tell(done);
        }
    }
    if (!records_.empty()) {
        set_busy(jobs.back().number, path_);
        tell(write_records());
    }
    set_busy(0, {});
}

Result<> Writer::Core::do_job(Job &job) {
    switch (job.kind) {
    case Job::Kind::BEGIN: return begin_file(job);
    case Job::Kind::PROGRESS:
        if (run_.has_value()) {
            run_->progress = job.run.progress;
            records_ += record(key_, *job.run.progress);
        }
        return {};
    case Job::Kind::DOUBT:
        if (run_.has_value() && !run_->doubt.has_value()) {
            run_->doubt = job.run.doubt;
            records_ += record(key_, *job.run.doubt);
        }
        return {};
    case Job::Kind::END:
        if (run_.has_value()) {
            run_->ended = true;
            records_ += end_record(key_);
        }
        return {};
    case Job::Kind::FORGET: {
        run_.reset();
        records_.clear();
        const auto removed = disk_->remove(path_);
        return removed.has_value() ? disk_->sync_folder_of(path_) : removed;
    }
    case Job::Kind::FILE: do_file(job); return {};
    case Job::Kind::READ: do_read(job); return {};
    }
    return {};
}

Result<> Writer::Core::put_file(const Job &job) {
    return job.old == Old::BACKED_UP ? rewrite_with_backup(*disk_, job.path, job.text)
                                     : disk_->rewrite(job.path, job.text);
}

void Writer::Core::do_file(Job &job) {
    const Result<> written = put_file(job);
    const std::string path = job.path;
    const std::lock_guard lock(mutex_);
    FileState &file = files_[path];
    file.done = job.number;
    file.failure = written.has_value() ? std::nullopt : std::optional(written.error());
    if (file.failure.has_value() && !job.awaited && !file.reported) {
        troubles_.push_back(fmt::format("{}. The content stays in memory and is written with the next change "
                                        "and at the end of the machine",
                                        file.failure->message));
    }
    file.reported = file.failure.has_value() && (file.reported || !job.awaited);
    if (file.failure.has_value()) {
        failed_.insert_or_assign(path, std::move(job));
    } else {
        failed_.erase(path);
    }
    done_.notify_all();
}

void Writer::Core::do_read(const Job &job) {
    if (const auto failed = failed_.find(job.path); failed != failed_.end()) {
        const Result<> written = put_file(failed->second);
        if (!written.has_value()) {
            job.then(std::unexpected(written.error()));
            return;
        }
        failed_.erase(failed);
        const std::lock_guard lock(mutex_);
        files_[job.path].failure.reset();
        files_[job.path].reported = false;
    }
    job.then(disk_->read(job.path));
}

void Writer::Core::write_failed() {
    Jobs jobs;
    for (auto &[path, job] : std::exchange(failed_, {})) {
        jobs.push_back(std::move(job));
    }
    do_jobs(jobs);
}

Result<> Writer::Core::begin_file(Job &job) {
    records_.clear();
    run_.reset();
    if (job.run.start.file == FileMark{}) {
        const auto content = disk_->read(job.run.start.program);
        if (!content.has_value()) {
            return std::unexpected(content.error());
        }
        job.run.start.file = mark_of(*content);
    }
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    job.run.start.id = static_cast<std::uint64_t>(now.tv_sec * NS_PER_S + now.tv_nsec) ^
                       static_cast<std::uint64_t>(::getpid());
    key_ = key_of(job.run.start);
    run_ = std::move(job.run);
    return rewrite();
}

Result<> Writer::Core::rewrite() {
    const std::string bytes = whole(*run_);
    records_.clear();
    const auto replaced = replace_file(*disk_, path_, bytes);
    file_sound_ = replaced.has_value();
    bytes_ = 0;
    return replaced;
}

Result<> Writer::Core::write_records() {
    if (!file_sound_ || bytes_ + records_.size() > MOST_RECORD_BYTES) {
        return rewrite();
    }
    // Records after an incomplete record are not found.
    file_sound_ = false;
    bytes_ += records_.size();
    auto done = disk_->append(path_, records_);
    records_.clear();
    done = done.has_value() ? disk_->sync(path_) : done;
    file_sound_ = done.has_value();
    return done;
}

void Writer::Core::tell(const Result<> &result) {
    const std::lock_guard lock(mutex_);
    if (!result.has_value() && !trouble_reported_) {
        troubles_.push_back("journal: " + result.error().message);
    }
    trouble_reported_ = !result.has_value();
}

}  // namespace mw::journal
