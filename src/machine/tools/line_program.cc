// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tools/line_program.hh"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>
#include <utility>

#include <fmt/format.h>

extern char **environ;

namespace mw::machine {
namespace {

/// Maximum length of a line, and of data waiting for a program that does not read. [bytes]
constexpr std::size_t MOST_BYTES = 65536;

void close_end(int &fd) {
    if (fd >= 0) {
        ::close(std::exchange(fd, -1));
    }
}

std::string ending_of(int status) {
    return WIFSIGNALED(status) ? fmt::format("it was ended by signal {}", WTERMSIG(status))
                               : fmt::format("it has ended with status {}", WEXITSTATUS(status));
}

}  // namespace

Result<LineProgram> LineProgram::start(const std::vector<std::string> &words, const std::string &folder) {
    LineProgram made;
    made.name_ = words.front();
    // Sockets are used, because a write to a pipe without a reader would send a signal to this process.
    int input[2] = {-1, -1}, output[2] = {-1, -1};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, input) != 0 ||
        ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, output) != 0) {
        close_end(input[0]);
        close_end(input[1]);
        return fail(fmt::format("cannot start '{}': {}", made.name_, std::strerror(errno)));
    }
    made.in_ = input[0];
    made.out_ = output[0];
    std::vector<std::string> copies = words;
    std::vector<char *> argv;
    for (std::string &word : copies) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&files, input[1], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, output[1], STDOUT_FILENO);
    if (!folder.empty()) {
        posix_spawn_file_actions_addchdir_np(&files, folder.c_str());
    }
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = posix_spawnp(&made.pid_, argv[0], &files, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    close_end(input[1]);
    close_end(output[1]);
    if (error != 0) {
        made.pid_ = 0;
        return fail(fmt::format("cannot start '{}': {}", made.name_, std::strerror(error)));
    }
    return made;
}

LineProgram::LineProgram(LineProgram &&other) noexcept {
    *this = std::move(other);
}

LineProgram &LineProgram::operator=(LineProgram &&other) noexcept {
    if (this != &other) {
        end();
        name_ = std::move(other.name_);
        pid_ = std::exchange(other.pid_, 0);
        ending_ = std::move(other.ending_);
        in_ = std::exchange(other.in_, -1);
        out_ = std::exchange(other.out_, -1);
        unsent_ = std::move(other.unsent_);
        received_ = std::move(other.received_);
    }
    return *this;
}

LineProgram::~LineProgram() {
    end();
}

void LineProgram::end() noexcept {
    using namespace std::chrono_literals;
    close_end(in_);
    close_end(out_);
    constexpr int SIGNALS[] = {0, SIGTERM, SIGKILL};
    constexpr int LOOKS = 50;  // number of checks for each stage
    for (const int signal : SIGNALS) {
        if (pid_ != 0 && signal != 0) {
            ::kill(-pid_, signal);
        }
        for (int i = 0; i < LOOKS && pid_ != 0; ++i) {
            int status = 0;
            if (::waitpid(pid_, &status, WNOHANG) != 0) {
                pid_ = 0;
            } else {
                std::this_thread::sleep_for(10ms);
            }
        }
    }
}

Result<> LineProgram::write(const std::string &line) {
    if (const auto ended = ending()) {
        return fail(fmt::format("'{}' cannot be queried: {}", name_, *ended));
    }
    if (unsent_.size() + line.size() > MOST_BYTES) {
        return fail(fmt::format("'{}' does not read its input", name_));
    }
    unsent_ += line + '\n';
    flush();
    return {};
}

void LineProgram::flush() {
    while (!unsent_.empty() && in_ >= 0) {
        const ssize_t sent = ::send(in_, unsent_.data(), unsent_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent <= 0) {
            return;
        }
        unsent_.erase(0, static_cast<std::size_t>(sent));
    }
}

void LineProgram::take_bytes() {
    char bytes[4096];
    while (out_ >= 0 && received_.size() < MOST_BYTES) {
        const ssize_t got = ::recv(out_, bytes, sizeof bytes, MSG_DONTWAIT);
        if (got <= 0) {
            return;
        }
        received_.append(bytes, static_cast<std::size_t>(got));
    }
}

std::optional<std::string> LineProgram::read() {
    flush();
    take_bytes();
    std::size_t end = received_.find('\n');
    const bool too_long = end == std::string::npos && received_.size() >= MOST_BYTES;
    if (end == std::string::npos && !too_long) {
        return std::nullopt;
    }
    end = std::min(end, received_.size());
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    if (!line.empty() && line.back() == '\r') {
        line.pop_back();
    }
    return line;
}

void LineProgram::sleep(double timeout_s) const {
    pollfd watched{out_, POLLIN, 0};
    ::poll(&watched, 1, static_cast<int>(timeout_s * 1e3));
}

std::optional<std::string> LineProgram::ending() {
    int status = 0;
    if (pid_ != 0 && ::waitpid(pid_, &status, WNOHANG) == pid_) {
        pid_ = 0;
        ending_ = ending_of(status);
    }
    return pid_ == 0 ? std::optional(ending_) : std::nullopt;
}

}  // namespace mw::machine
