// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/programs.hh"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "hal/core/command_hints.hh"

extern char **environ;

namespace mw::hal::script {

namespace {

constexpr long POLL_NS = 2000000;
/// Interval for checking the realtime process.
constexpr long LOOK_NS = 10 * POLL_NS;
/// Time after which a program that is not ready is reported.
constexpr long PATIENCE_NS = 2000 * POLL_NS;
/// From SIGTERM to SIGKILL: longer than our Python components need if their loop ignores the interrupt.
constexpr long GRACE_NS = 2500 * POLL_NS;

void nap() {
    const timespec pause{0, POLL_NS};
    nanosleep(&pause, nullptr);
}

std::string how_ended(int status) {
    if (WIFSIGNALED(status)) {
        return fmt::format("was ended by signal {}", WTERMSIG(status));
    }
    return fmt::format("ended with status {}", WEXITSTATUS(status));
}

}  // namespace

std::string base_name(const std::string &path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? path : path.substr(slash + 1);
}

Result<ProgramStart> SystemProgramHost::start(const ProgramRequest &request) {
    std::vector<char *> argv;
    argv.reserve(request.argv.size() + 1);
    for (const std::string &word : request.argv) {
        argv.push_back(const_cast<char *>(word.c_str()));
    }
    argv.push_back(nullptr);
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, argv[0], nullptr, nullptr, argv.data(), environ);
    if (error != 0) {
        return fail(fmt::format("cannot start '{}': {}", request.argv[0], std::strerror(error)), {},
                    hint_for_absent(base_name(request.argv[0])));
    }
    children_.push_back(pid);
    started_ = true;
    Result<> waited;
    if (request.wait == ProgramRequest::Wait::UNTIL_READY) {
        waited = wait_until_ready(request, pid);
    } else if (request.wait == ProgramRequest::Wait::UNTIL_END) {
        waited = wait_for_status(request, pid);
    }
    if (!waited) {
        return std::unexpected(waited.error());
    }
    return ProgramStart::RUNNING;
}

Result<> SystemProgramHost::wait_until_ready(const ProgramRequest &request, int pid) {
    for (long waited_ns = 0;; waited_ns += POLL_NS) {
        const Result<CompInfo> component = hal_.components().find(request.component);
        if (component && component->isReady) {
            return {};
        }
        if (waited_ns == PATIENCE_NS) {
            language::tell(fmt::format("still waiting for component '{}' of program '{}'", request.component,
                                       request.argv[0]));
        }
        int status = 0;
        if (waitpid(pid, &status, WNOHANG) == pid) {
            return fail(fmt::format("program '{}' {} before its component '{}' was ready", request.argv[0],
                                    how_ended(status), request.component));
        }
        if (isStopped()) {
            kill(pid, SIGTERM);
            return fail(fmt::format("stopped while waiting for component '{}'", request.component));
        }
        if (const auto end = waited_ns % LOOK_NS == 0 ? hal_.host_status().end_reason() : std::nullopt) {
            kill(pid, SIGTERM);
            return fail(fmt::format("the realtime process has ended during the wait for component '{}': {}",
                                    request.component, *end));
        }
        nap();
    }
}

Result<> SystemProgramHost::wait_for_status(const ProgramRequest &request, int pid) {
    constexpr int LOOK_MS = 50;
    // A stop signal may arrive before the wait begins, so a wait is limited to this time.
    const int end = static_cast<int>(syscall(SYS_pidfd_open, pid, 0));
    const auto closed = [](const int *file) {
        if (*file >= 0) {
            close(*file);
        }
    };
    const std::unique_ptr<const int, decltype(closed)> closing(&end, closed);
    int status = 0;
    for (pid_t found = 0; found != pid;) {
        found = waitpid(pid, &status, WNOHANG);
        if (found < 0) {
            return fail(
                fmt::format("program '{}' cannot be monitored: {}", request.argv[0], std::strerror(errno)));
        }
        if (found == 0 && isStopped()) {
            kill(pid, SIGTERM);
            return fail(fmt::format("stopped while waiting for '{}'", request.argv[0]));
        }
        if (found == 0) {
            pollfd one{.fd = end, .events = POLLIN, .revents = 0};
            poll(&one, 1, LOOK_MS);
        }
    }
    const bool fine = WIFEXITED(status) && WEXITSTATUS(status) == 0;
    if (!fine && !request.ignoresStatus) {
        return fail(fmt::format("program '{}' {}", request.argv[0], how_ended(status)));
    }
    return {};
}

Result<> SystemProgramHost::stop(const std::string &component) {
    const Result<CompInfo> info = hal_.components().find(component);
    if (!info) {
        return std::unexpected(info.error());
    }
    (void)hal_.processes().expect_end(info->id);
    if (info->pid > 0 && info->pid != getpid() && kill(info->pid, SIGTERM) != 0 && errno != ESRCH) {
        return fail(fmt::format("cannot end component '{}' (process {}): {}", component, info->pid,
                                std::strerror(errno)));
    }
    return {};
}

Result<> SystemProgramHost::stop_all() {
    Result<> result;
    for (const CompInfo &component : hal_.components().list()) {
        const bool own = component.pid == getpid();
        if (component.type != CompType::USER || own) {
            continue;
        }
        const Result<> stopped = stop(component.name);
        if (!stopped && result) {
            result = stopped;
        }
    }
    // Also ends programs that have no component yet. They would join a HAL that has ended, or the next HAL.
    reap();
    for (const int pid : children_) {
        kill(pid, SIGTERM);
    }
    // Time for an orderly end; programs that exceed it are killed.
    await_end(GRACE_NS);
    kill_programs();
    await_end(PATIENCE_NS);
    hal_.processes().reap_dead();
    return result;
}

void SystemProgramHost::await_end(long longest_ns) {
    for (long waited_ns = 0; waited_ns < longest_ns && isProgramLeft(); waited_ns += POLL_NS) {
        reap();
        nap();
    }
}

/// Kills the programs that ignore SIGTERM. They would outlive the machine, with their pins and their
/// hardware.
void SystemProgramHost::kill_programs() {
    for (const CompInfo &component : hal_.components().list()) {
        if (isProgram(component) && kill(component.pid, SIGKILL) == 0) {
            language::tell(fmt::format("component '{}' (process {}) has not ended at SIGTERM: killed",
                                       component.name, component.pid));
        }
    }
    for (const int pid : children_) {
        if (!isComponent(pid) && kill(pid, SIGKILL) == 0) {
            language::tell(
                fmt::format("a program of loadusr (process {}) has not ended at SIGTERM: killed", pid));
        }
    }
}

bool SystemProgramHost::isComponent(int pid) const {
    const auto components = hal_.components().list();
    return std::any_of(components.begin(), components.end(),
                       [pid](const CompInfo &component) { return component.pid == pid; });
}

bool SystemProgramHost::isProgram(const CompInfo &component) {
    return component.type == CompType::USER && component.pid > 0 && component.pid != getpid();
}

bool SystemProgramHost::isProgramLeft() const {
    for (const CompInfo &component : hal_.components().list()) {
        if (isProgram(component) && kill(component.pid, 0) == 0) {
            return true;
        }
    }
    return !children_.empty();
}

/// kill() reports an ended process as alive until its parent reads its status, and the parents of some
/// components never read it.
void SystemProgramHost::reap() {
    std::erase_if(children_, [](int pid) { return waitpid(pid, nullptr, WNOHANG) != 0; });
    hal_.processes().reap_dead();
}

Result<> SystemProgramHost::wait_for_end(const std::string &component) {
    while (true) {
        const Result<CompInfo> info = hal_.components().find(component);
        if (!info) {
            return {};
        }
        reap();
        if (isStopped()) {
            return fail(fmt::format("stopped while waiting for the end of '{}'", component));
        }
        nap();
    }
}

Result<ProgramStart> InProcessProgramHost::start(const ProgramRequest &request) {
    const auto part = parts_.find(base_name(request.argv[0]));
    if (part == parts_.end()) {
        return ProgramStart::LEFT_OUT;
    }
    const Result<> made = part->second(request);
    if (!made) {
        return std::unexpected(made.error());
    }
    return ProgramStart::RUNNING;
}

Result<> InProcessProgramHost::stop(const std::string &component) {
    return fail(fmt::format("'{}' is a part of this process and ends with it", component));
}

Result<> InProcessProgramHost::wait_for_end(const std::string &component) {
    return fail(
        fmt::format("'{}' is a part of this process: waiting for its end would never end", component));
}

}  // namespace mw::hal::script
