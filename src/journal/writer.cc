// SPDX-License-Identifier: GPL-2.0-or-later
#include "journal/writer.hh"

#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace mw::journal {
namespace {

/// Above what it began with; then it is written anew.
constexpr std::uint64_t MOST_RECORD_BYTES = 1U << 20U;
/// A disk that takes longer lets the journal fall behind the tool.
constexpr double SLOW_S = 0.8;
constexpr std::int64_t NS_PER_S = 1000000000;

std::string whole(const Run &run) {
    const std::uint64_t key = key_of(run.start);
    std::string bytes = begin_bytes(run.start);
    bytes += run.doubt.has_value() ? record(key, *run.doubt) : "";
    bytes += run.progress.has_value() ? record(key, *run.progress) : "";
    bytes += run.hasEnded ? end_record(key) : "";
    return bytes;
}

std::string why_not(Disk &disk, const Start &start) {
    if (!disk.exists(start.program)) {
        return "its file is gone";
    }
    const auto content = disk.read(start.program);
    if (!content.has_value()) {
        return content.error().message;
    }
    return mark_of(*content) == start.file ? "" : "its file has been changed since";
}

}  // namespace

Writer::Writer(std::unique_ptr<Disk> disk, std::string path, Works works)
    : disk_(std::move(disk)), path_(std::move(path)) {
    find();
    if (works == Works::ALONE) {
        thread_ = std::thread([this] { run_thread(); });
    }
}

Writer::~Writer() {
    {
        const std::lock_guard lock(mutex_);
        isEnding_ = true;
    }
    asked_.notify_one();
    if (thread_.joinable()) {
        thread_.join();
    } else {
        work();
    }
}

void Writer::find() {
    if (path_.empty() || !disk_->exists(path_)) {
        return;
    }
    const auto bytes = disk_->read(path_);
    auto run = bytes.has_value() ? read_run(*bytes) : std::unexpected(bytes.error());
    if (!run.has_value()) {
        trouble_ =
            path_ + ": " + run.error().message + ": a program that was cut short cannot be gone on with";
    } else if (!run->hasEnded && run->progress.has_value()) {
        found_.refusal = why_not(*disk_, run->start);
        found_.run = std::move(*run);
    }
}

void Writer::ask(Job job) {
    {
        const std::lock_guard lock(mutex_);
        job.number = ++last_job_;
        if (job.kind == Kind::BEGIN || job.kind == Kind::FORGET) {  // what was before does not matter
            std::erase_if(jobs_, [](const Job &one) { return one.kind != Kind::FILE; });
        }
        const auto same = std::ranges::find_if(jobs_, [&](const Job &one) {
            return one.kind == job.kind &&
                   (job.kind == Kind::FILE ? one.path == job.path
                                           : job.kind == Kind::PROGRESS && &one == &jobs_.back());
        });
        if (same != jobs_.end()) {
            *same = std::move(job);
        } else {
            jobs_.push_back(std::move(job));
        }
    }
    asked_.notify_one();
}

void Writer::begin(Start start, std::optional<Progress> progress, std::optional<Doubt> doubt) {
    ask({Kind::BEGIN, {std::move(start), std::move(progress), std::move(doubt), false}, {}, {}, 0});
}

void Writer::note(const Progress &progress) {
    ask({Kind::PROGRESS, {{}, progress, {}, false}, {}, {}, 0});
}

void Writer::note(const Doubt &doubt) {
    ask({Kind::DOUBT, {{}, {}, doubt, false}, {}, {}, 0});
}

void Writer::end() {
    ask({Kind::END, {}, {}, {}, 0});
}

void Writer::forget() {
    ask({Kind::FORGET, {}, {}, {}, 0});
}

void Writer::keep_file(const std::string &path, std::string text, Old old) {
    ask({Kind::FILE, {}, path, std::move(text), 0, old});
}

Result<> Writer::put_file(const std::string &path, const std::string &text, Old old) {
    return old == Old::BACKED_UP ? rewrite_with_backup(*disk_, path, text) : disk_->rewrite(path, text);
}

Result<> Writer::write_file(const std::string &path, const std::string &text, Old old) {
    std::uint64_t number = 0;
    {
        const std::lock_guard lock(mutex_);
        number = ++last_job_;
        std::erase_if(jobs_, [&](const Job &one) { return one.kind == Kind::FILE && one.path == path; });
    }
    // The thread may have taken an older text already: it is done, or will find this number.
    const std::lock_guard lock(disk_mutex_);
    written_[path] = number;
    return put_file(path, text, old);
}

std::optional<std::string> Writer::take_trouble() {
    const std::lock_guard lock(mutex_);
    return std::exchange(trouble_, std::nullopt);
}

bool Writer::work() {
    Jobs jobs;
    {
        const std::lock_guard lock(mutex_);
        jobs.swap(jobs_);
    }
    do_jobs(jobs);
    return !jobs.empty();
}

void Writer::run_thread() {
    while (true) {
        {
            std::unique_lock lock(mutex_);
            asked_.wait(lock, [this] { return isEnding_ || !jobs_.empty(); });
            if (jobs_.empty()) {
                return;
            }
        }
        const auto began = std::chrono::steady_clock::now();
        work();
        const double took_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        if (took_s > SLOW_S) {
            tell(fail("the disk was slow: after a power cut the program would go on at an earlier place"));
        }
    }
}

/// An error is told, and what comes after it is done all the same.
void Writer::do_jobs(Jobs &jobs) {
    for (Job &job : jobs) {
        const std::lock_guard lock(disk_mutex_);
        const auto done = do_job(job);
        if (!done.has_value()) {
            tell(done);
        }
    }
    if (!records_.empty()) {
        const std::lock_guard lock(disk_mutex_);
        tell(write_records());
    }
}

Result<> Writer::do_job(Job &job) {
    switch (job.kind) {
    case Kind::BEGIN: return begin_file(job);
    case Kind::PROGRESS:
        if (run_.has_value()) {
            run_->progress = job.run.progress;
            records_ += record(key_, *job.run.progress);
        }
        return {};
    case Kind::DOUBT:
        if (run_.has_value() && !run_->doubt.has_value()) {
            run_->doubt = job.run.doubt;
            records_ += record(key_, *job.run.doubt);
        }
        return {};
    case Kind::END:
        if (run_.has_value()) {
            run_->hasEnded = true;
            records_ += end_record(key_);
        }
        return {};
    case Kind::FORGET: {
        run_.reset();
        records_.clear();
        const auto removed = disk_->remove(path_);
        return removed.has_value() ? disk_->sync_folder_of(path_) : removed;
    }
    case Kind::FILE: return do_file(job);
    }
    return {};
}

Result<> Writer::do_file(const Job &job) {
    const auto written = written_.find(job.path);
    const bool isOld = written != written_.end() && job.number < written->second;
    return isOld ? Result<>{} : put_file(job.path, job.text, job.old);
}

Result<> Writer::begin_file(Job &job) {
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

Result<> Writer::rewrite() {
    const std::string bytes = whole(*run_);
    records_.clear();
    const auto replaced = replace_file(*disk_, path_, bytes);
    isFileSound_ = replaced.has_value();
    bytes_ = 0;
    return replaced;
}

Result<> Writer::write_records() {
    if (!isFileSound_ || bytes_ + records_.size() > MOST_RECORD_BYTES) {
        return rewrite();
    }
    // Behind a record that is torn no other is found.
    isFileSound_ = false;
    bytes_ += records_.size();
    auto done = disk_->append(path_, records_);
    records_.clear();
    done = done.has_value() ? disk_->sync(path_) : done;
    isFileSound_ = done.has_value();
    return done;
}

void Writer::tell(const Result<> &result) {
    const std::lock_guard lock(mutex_);
    if (!result.has_value() && !isTroubleTold_) {
        trouble_ = "journal: " + result.error().message;
    }
    isTroubleTold_ = !result.has_value();
}

}  // namespace mw::journal
