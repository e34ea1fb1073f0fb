// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/setup/steps_process.hh"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/own_place.hh"
#include "programs/setup/changed_machine.hh"

namespace mw::programs {
namespace {

/// Input and output are one end of a socket pair, so writing never blocks and raises no signal.
class Child final : public screen::StepsProcess {
  public:
    Child(int fd, pid_t pid) : fd_(fd), pid_(pid) {}
    Child(const Child &) = delete;
    Child &operator=(const Child &) = delete;
    ~Child() override {
        close();
        // The process switches the machine off first. Only a process that hangs is killed; its watchdog has
        // then switched the machine off.
        constexpr int LOOKS = 100, LOOK_US = 100'000;
        for (int i = 0; i < LOOKS && !hasEnded(); ++i) {
            ::usleep(LOOK_US);
        }
        if (!hasEnded()) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
        ::close(fd_);
    }

    void send(std::string_view line) override {
        const std::string whole = std::string(line) + "\n";
        // A part of a line would corrupt the next line, so a line that cannot be sent completely ends the
        // session.
        const ssize_t sent = ::send(fd_, whole.data(), whole.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent >= 0 && static_cast<std::size_t>(sent) != whole.size()) {
            close();
        }
    }

    std::optional<std::string> next_line() override {
        std::array<char, 16384> part{};
        for (ssize_t size = 1; size > 0;) {
            size = ::recv(fd_, part.data(), part.size(), MSG_DONTWAIT);
            input_.append(part.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
        }
        const std::size_t end = input_.find('\n');
        if (end == std::string::npos) {
            return std::nullopt;
        }
        std::string line = input_.substr(0, end);
        input_.erase(0, end + 1);
        return line;
    }

    void close() override { ::shutdown(fd_, SHUT_WR); }

    bool hasEnded() override {
        hasEnded_ = hasEnded_ || ::waitpid(pid_, nullptr, WNOHANG) != 0;
        return hasEnded_;
    }

  private:
    int fd_;
    pid_t pid_;
    bool hasEnded_ = false;
    std::string input_;
};

}  // namespace

Result<std::unique_ptr<screen::StepsProcess>> start_steps(const std::string &ini) {
    const std::string folder = std::filesystem::path(ini).parent_path().string();
    std::vector<std::string> words{
        program_folder() + "/millwright", "commission", "check", folder, "--all", "--messages"};
    const auto answers = recorded_answers(folder);
    if (!answers.has_value()) {
        return std::unexpected(answers.error());
    }
    if (setup::plan_of(*answers).plan.wiring.isSimulated) {
        words.emplace_back("--simulate");
    }
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return fail("cannot create a pipe");
    }
    std::vector<char *> pointers;
    for (std::string &word : words) {
        pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    pid_t pid = 0;
    const int status = ::posix_spawn(&pid, pointers[0], &actions, nullptr, pointers.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (status != 0) {
        ::close(ends[0]);
        return fail("'" + words[0] + "' cannot be started");
    }
    return std::make_unique<Child>(ends[0], pid);
}

}  // namespace mw::programs
