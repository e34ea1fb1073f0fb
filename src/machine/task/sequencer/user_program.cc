// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/sequencer/user_program.hh"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "base/memory_killer.hh"

extern char **environ;

namespace mw::task {
namespace {

Result<> result_of(const std::string &path, int status) {
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        return {};
    }
    return WIFSIGNALED(status)
               ? fail(fmt::format("user M code {} was ended by signal {}", path, WTERMSIG(status)))
               : fail(fmt::format("user M code {} ended with status {}", path, WEXITSTATUS(status)));
}

/// Starts the process of the program.
Result<int> spawn(const std::string &path, double p, double q) {
    std::string words[] = {path, fmt::format("{:.6f}", p), fmt::format("{:.6f}", q)};
    char *argv[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t pid = 0;
    const int error = posix_spawn(&pid, path.c_str(), &files, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    if (error != 0) {
        return fail(fmt::format("cannot start user M code {}: {}", path, std::strerror(error)));
    }
    static_cast<void>(raise_oom_score(PROGRAM_OOM_STEP, pid));
    return pid;
}

/// Kills a program and everything it has started.
void kill_group(int pid) {
    kill(-pid, SIGKILL);
}

/// waitpid() that signals do not interrupt.
int wait_for(int pid, int *status, int options) {
    int ended = 0;
    do {
        ended = waitpid(pid, status, options);
    } while (ended < 0 && errno == EINTR);
    return ended;
}

}  // namespace

/// The start of one program.
struct UserProgram::Start {
    Find find;
    double p = 0, q = 0;

    std::mutex mutex;
    // Guarded by the mutex, which is not held during disk access.
    bool dropped = false;
    std::string path;
    std::optional<Result<int>> process;

    /// Finds and starts the program, unless it was dropped in the meantime.
    void run() {
        const Result<std::string> found = find();
        {
            const std::lock_guard lock(mutex);
            if (dropped) {
                return;
            }
        }
        Result<int> started = found.has_value() ? spawn(*found, p, q) : std::unexpected(found.error());
        {
            const std::lock_guard lock(mutex);
            if (!dropped) {
                path = found.value_or("");
                process = started;
                return;
            }
        }
        if (started.has_value()) {
            kill_group(*started);
            wait_for(*started, nullptr, 0);
        }
    }
};

void UserProgram::start(const std::string &name, Find find, double p, double q) {
    stop();
    name_ = name;
    result_ = {};
    start_since_ns_.reset();
    start_ = std::make_shared<Start>();
    start_->find = std::move(find);
    start_->p = p;
    start_->q = q;
    if (waits_ == Waits::IN_CALL) {
        start_->run();
        return;
    }
    std::thread([start = start_] { start->run(); }).detach();
}

/// Takes the process of a completed start.
void UserProgram::take_start() {
    if (start_ == nullptr) {
        return;
    }
    const std::shared_ptr<Start> start = start_;
    const std::lock_guard lock(start->mutex);
    if (!start->process.has_value()) {
        return;
    }
    start_.reset();
    path_ = start->path;
    pid_ = start->process->value_or(0);
    if (!start->process->has_value()) {
        result_ = std::unexpected(start->process->error());
    }
}

bool UserProgram::isRunning() {
    reap();
    take_start();
    if (pid_ == 0) {
        return start_ != nullptr;
    }
    int status = 0;
    const int ended = wait_for(pid_, &status, waits_ == Waits::IN_CALL ? 0 : WNOHANG);
    if (ended == 0) {
        return true;
    }
    result_ = ended == pid_
                  ? result_of(path_, status)
                  : fail(fmt::format("user M code {} cannot be monitored: {}", path_, std::strerror(errno)));
    pid_ = 0;
    return false;
}

Result<> UserProgram::take_result() {
    return std::exchange(result_, {});
}

void UserProgram::stop() {
    take_start();
    if (start_ != nullptr) {
        const std::shared_ptr<Start> start = std::exchange(start_, nullptr);
        const std::lock_guard lock(start->mutex);
        start->dropped = true;
        if (start->process.has_value()) {
            pid_ = start->process->value_or(0);
        }
    }
    if (pid_ != 0) {
        kill_group(pid_);
        ended_.push_back(std::exchange(pid_, 0));
    }
    reap();
}

/// The kernel ends a process later if its disk does not answer.
void UserProgram::reap() {
    std::erase_if(ended_, [](int pid) { return wait_for(pid, nullptr, WNOHANG) != 0; });
}

std::optional<std::string> UserProgram::take_delay(std::int64_t now_ns) {
    constexpr std::int64_t LATE_NS = 1000000000;
    reap();
    take_start();
    if (start_ == nullptr || !start_since_ns_.has_value()) {
        delay_reported_ = false;
        start_since_ns_ = start_ == nullptr ? std::nullopt : std::optional(now_ns);
        return std::nullopt;
    }
    if (delay_reported_ || now_ns - *start_since_ns_ < LATE_NS) {
        return std::nullopt;
    }
    delay_reported_ = true;
    return fmt::format("the disk of {} has not answered for 1 s", name_);
}

}  // namespace mw::task
