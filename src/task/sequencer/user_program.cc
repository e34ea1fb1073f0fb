// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/sequencer/user_program.hh"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
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

}  // namespace

Result<> UserProgram::start(const std::string &path, double p, double q) {
    stop();
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
    pid_ = pid;
    path_ = path;
    result_ = {};
    return {};
}

bool UserProgram::isRunning() {
    if (pid_ == 0) {
        return false;
    }
    int status = 0;
    pid_t ended = 0;
    do {
        ended = waitpid(pid_, &status, isBlocking_ ? 0 : WNOHANG);
    } while (ended < 0 && errno == EINTR);
    if (ended == 0) {
        return true;
    }
    result_ = ended == pid_
                  ? result_of(path_, status)
                  : fail(fmt::format("lost sight of user M code {}: {}", path_, std::strerror(errno)));
    pid_ = 0;
    return false;
}

Result<> UserProgram::take_result() {
    return std::exchange(result_, {});
}

void UserProgram::stop() {
    if (pid_ == 0) {
        return;
    }
    kill(-pid_, SIGKILL);
    int status = 0;
    while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = 0;
}

}  // namespace mw::task
