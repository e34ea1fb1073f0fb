// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/start/display_program.hh"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "base/find_program.hh"
#include "base/memory_killer.hh"
#include "base/output_relay.hh"
#include "base/own_place.hh"
#include "base/text.hh"
#include "hal/core/command_hints.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;

/// Equivalent to DISPLAY = millwright: the screen of `millwright ui`.
constexpr const char *OWN_SCREEN = "millwright";

/// Runs in the forked child. Only async-signal-safe calls.
[[noreturn]] void become_display(char *const argv[], const char *folder, pid_t parent, int failed) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) {
        ::signal(number, SIG_DFL);
    }
    OutputRelay::restore_in_child();
    if (::getppid() == parent && ::chdir(folder) == 0) {
        ::execv(argv[0], argv);
    }
    const int error = errno;
    (void)!::write(failed, &error, sizeof error);
    ::_exit(127);
}

}  // namespace

Result<std::vector<std::string>> DisplayProgram::words(const std::string &display, const std::string &ini,
                                                       const std::vector<std::string> &more) {
    std::vector<std::string> words = split_words(display);
    if (words.empty()) {
        return fail("[DISPLAY]DISPLAY names no program", {ini, 0, 0});
    }
    if (words[0] == OWN_SCREEN) {
        words[0] = program_folder() + "/millwright";
        words.insert(words.begin() + 1, {"ui", ini, "--open", "--display"});
        return words;
    }
    if (words[0] == "dummy") {
        return std::vector<std::string>{"/bin/sh", "-c", "echo 'press ENTER to end'; read -r line"};
    }
    const char *const tcl = std::getenv("LINUXCNC_TCL_DIR");
    if (tcl != nullptr && (words[0] == "tklinuxcnc" || words[0] == "tkemc")) {
        words[0] = std::string(tcl) + "/tklinuxcnc.tcl";
    }
    words.insert(words.end(), more.begin(), more.end());
    const std::string program = find_program(words[0], fs::path(ini).parent_path().string());
    if (program.empty()) {
        const std::string instead = hal::hint_for_absent(fs::path(words[0]).filename().string());
        return fail("[DISPLAY]DISPLAY names '" + words[0] + "': program not found", {ini, 0, 0},
                    instead.empty() ? "--no-display runs the machine without a display" : instead);
    }
    const bool is_shell = fs::path(words[0]).filename() == "linuxcncrsh";
    words[0] = program;
    if (is_shell) {
        words.insert(words.end(), {"--", "-ini", ini});
    } else {
        words.insert(words.begin() + 1, {"-ini", ini});
    }
    return words;
}

Result<DisplayProgram> DisplayProgram::start(const std::vector<std::string> &words, const std::string &ini) {
    const std::string folder = fs::path(ini).parent_path().string();
    // Everything is prepared before the fork, because the child of a process with threads may not allocate
    // memory.
    ::setenv("INI_FILE_NAME", ini.c_str(), 1);
    ::setenv("CONFIG_DIR", folder.c_str(), 1);
    std::vector<std::string> owned = words;
    std::vector<char *> argv;
    for (std::string &word : owned) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    int failed[2];
    if (::pipe2(failed, O_CLOEXEC) != 0) {
        return fail(std::string("cannot create a pipe: ") + std::strerror(errno));
    }
    const pid_t parent = ::getpid();
    const pid_t child = ::fork();
    if (child == 0) {
        become_display(argv.data(), folder.c_str(), parent, failed[1]);
    }
    int error = child < 0 ? errno : 0;
    static_cast<void>(raise_oom_score(PROGRAM_OOM_STEP, child));
    ::close(failed[1]);
    while (child > 0 && ::read(failed[0], &error, sizeof error) < 0 && errno == EINTR) {
    }
    ::close(failed[0]);
    if (error != 0) {
        if (child > 0) {
            ::waitpid(child, nullptr, 0);
        }
        return fail(fmt::format("cannot start {}: {}", words[0], std::strerror(error)));
    }
    return DisplayProgram(child);
}

DisplayProgram::DisplayProgram(DisplayProgram &&other) noexcept
    : pid_(std::exchange(other.pid_, -1)), end_(other.end_) {}

DisplayProgram::~DisplayProgram() {
    kill();
}

std::optional<int> DisplayProgram::end() {
    int status = 0;
    if (!end_.has_value() && pid_ > 0 && ::waitpid(pid_, &status, WNOHANG) == pid_) {
        constexpr int BY_SIGNAL = 128;
        end_ = WIFEXITED(status) ? WEXITSTATUS(status) : BY_SIGNAL + WTERMSIG(status);
    }
    return end_;
}

void DisplayProgram::ask_to_end() {
    if (pid_ > 0 && !end().has_value()) {
        ::kill(pid_, SIGTERM);
    }
}

void DisplayProgram::kill() {
    if (pid_ > 0 && !end().has_value()) {
        ::kill(pid_, SIGKILL);
        ::waitpid(pid_, nullptr, 0);
        end_ = 128 + SIGKILL;
    }
}

}  // namespace mw::programs
