// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/journal/writer.hh"

#include <chrono>
#include <cstdio>
#include <utility>

#include "machine/journal/writer_core.hh"

namespace mw::journal {
namespace {

constexpr std::chrono::seconds LONGEST_WAIT{1};
constexpr std::chrono::milliseconds LONGEST_END{500};

}  // namespace

Writer::Writer(std::unique_ptr<Disk> disk, std::string path, Works works)
    : core_(std::make_shared<Core>(std::move(disk), std::move(path))) {
    core_->find();
    if (works == Works::ALONE) {
        thread_ = std::thread([core = core_] { core->run_thread(); });
    }
}

bool Writer::isOn() const {
    return core_->isJournalled();
}

const Found &Writer::found() const {
    return core_->found();
}

void Writer::begin(Start start, std::optional<Progress> progress, std::optional<Doubt> doubt) {
    Job job;
    job.kind = Job::Kind::BEGIN;
    job.run = {std::move(start), std::move(progress), std::move(doubt), false};
    core_->ask(std::move(job));
}

void Writer::note(const Progress &progress) {
    Job job;
    job.kind = Job::Kind::PROGRESS;
    job.run.progress = progress;
    core_->ask(std::move(job));
}

void Writer::note(const Doubt &doubt) {
    Job job;
    job.kind = Job::Kind::DOUBT;
    job.run.doubt = doubt;
    core_->ask(std::move(job));
}

void Writer::end() {
    core_->ask({});
}

void Writer::forget() {
    Job job;
    job.kind = Job::Kind::FORGET;
    core_->ask(std::move(job));
}

void Writer::keep_file(const std::string &path, std::string text, Old old) {
    Job job;
    job.kind = Job::Kind::FILE;
    job.path = path;
    job.text = std::move(text);
    job.old = old;
    core_->ask(std::move(job));
}

Result<> Writer::write_file(const std::string &path, const std::string &text, Old old) {
    Job job;
    job.kind = Job::Kind::FILE;
    job.path = path;
    job.text = text;
    job.old = old;
    job.awaited = true;
    core_->ask(std::move(job));
    if (!thread_.joinable()) {
        work();
    }
    return core_->wait_for(path, LONGEST_WAIT);
}

void Writer::read_file(const std::string &path, Then then) {
    Job job;
    job.kind = Job::Kind::READ;
    job.path = path;
    job.then = std::move(then);
    core_->ask(std::move(job));
}

bool Writer::isSettled(const std::string &path) const {
    return core_->isSettled(path);
}

std::optional<std::string> Writer::take_trouble() {
    return core_->take_trouble();
}

std::optional<std::string> Writer::take_delay(std::int64_t now_ns) {
    return core_->take_delay(now_ns);
}

bool Writer::work() {
    return core_->work();
}

void Writer::finish() {
    if (std::exchange(finished_, true)) {
        return;
    }
    if (!thread_.joinable()) {
        work();
        core_->write_failed();
        return;
    }
    if (core_->end_thread(LONGEST_END)) {
        thread_.join();
    } else {
        thread_.detach();  // the thread shares the core
    }
    for (const std::string &reason : core_->unwritten()) {
        std::fputs((reason + '\n').c_str(), stderr);
    }
}

}  // namespace mw::journal
