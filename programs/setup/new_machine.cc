// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/setup/new_machine.hh"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "base/atomic_file.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "base/unfinished_folder.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;

constexpr auto LONGEST_TRIAL = std::chrono::seconds(120);
constexpr std::size_t MOST_OUTPUT = 256UL * 1024;

Result<> write_files(const fs::path &folder, const std::vector<setup::File> &files) {
    std::error_code error;
    for (const setup::File &file : files) {
        const fs::path path = folder / file.name;
        fs::create_directories(path.parent_path(), error);
        if (error) {
            return fail("cannot create the folder '" + path.parent_path().string() + "': " + error.message());
        }
        if (auto written = write_file_atomically(path.string(), file.text); !written.has_value()) {
            return written;
        }
    }
    return {};
}

/// A process whose output is read.
class Child {
  public:
    ~Child() {
        if (output_ >= 0) {
            ::close(output_);
        }
        if (pid_ > 0) {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
    }
    Child() = default;
    Child(const Child &) = delete;
    Child &operator=(const Child &) = delete;

    Result<> start(std::vector<std::string> words) {
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
            return fail("cannot create a pipe");
        }
        output_ = ends[0];
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
        std::vector<char *> pointers;
        for (std::string &word : words) {
            pointers.push_back(word.data());
        }
        pointers.push_back(nullptr);
        const int status = ::posix_spawn(&pid_, pointers[0], &actions, nullptr, pointers.data(), environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        if (status != 0) {
            pid_ = 0;
            return fail("'" + words[0] + "' cannot be started");
        }
        return {};
    }
    /// False if it did not end in time, or a stop signal arrived.
    bool read_to_end(std::string &output) {
        constexpr int LOOK_MS = 100;
        const auto end = std::chrono::steady_clock::now() + LONGEST_TRIAL;
        while (stop_signal == 0 && std::chrono::steady_clock::now() < end) {
            pollfd look{output_, POLLIN, 0};
            if (::poll(&look, 1, LOOK_MS) <= 0) {
                continue;
            }
            std::array<char, 4096> part{};
            const ssize_t size = ::read(output_, part.data(), part.size());
            if (size <= 0) {
                return true;
            }
            if (output.size() < MOST_OUTPUT) {
                output.append(part.data(), static_cast<std::size_t>(size));
            }
        }
        return false;
    }
    /// Result of a process that has closed its output.
    bool hasSucceeded() {
        int status = 0;
        const bool ended = ::waitpid(pid_, &status, 0) == pid_;
        pid_ = 0;
        return ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

  private:
    int output_ = -1;
    pid_t pid_ = 0;
};

}  // namespace

Result<setup::Answers> read_answers(const std::string &text, const std::string &name) {
    setup::Answers answers;
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::string_view words = trim(line);
        if (words.empty() || words.starts_with('#')) {
            continue;
        }
        const std::size_t equals = words.find('=');
        const std::string key(trim(words.substr(0, equals)));
        if (equals == std::string_view::npos || key.empty()) {
            return fail("write an answer as 'key = value'", {name, number, 1});
        }
        if (!answers.emplace(key, trim(words.substr(equals + 1))).second) {
            return fail("'" + printable(key) + "' is set twice", {name, number, 1});
        }
    }
    return answers;
}

std::string answers_text(const setup::Answers &given) {
    std::string text =
        "# What was answered. `millwright commission write` changes the machine; another one like it: "
        "millwright setup FOLDER --answers " +
        std::string(ANSWERS_FILE) + "\n";
    const auto asked = setup::questions(given);
    for (const setup::Question &question : asked) {
        text += question.key + " = " + setup::answer_of(asked, given, question.key) + '\n';
    }
    return text;
}

Result<> write_generated(const std::string &folder, const std::vector<setup::File> &files) {
    return write_files(fs::path(folder) / GENERATED_FOLDER, files);
}

Result<NewMachine> make_machine(const std::string &folder, const setup::Plan &plan,
                                const setup::Answers &given) {
    std::error_code error;
    fs::path to = fs::absolute(folder, error).lexically_normal();
    to = to.has_filename() ? to : to.parent_path();  // "my_mill/"
    const bool present = fs::exists(fs::symlink_status(to, error));
    if (present && !(fs::is_directory(to, error) && fs::is_empty(to, error))) {
        return fail("'" + to.string() + "' exists already and is not changed", {},
                    "the folder of the machine must be empty or new");
    }
    fs::create_directories(to.parent_path(), error);
    if (error) {
        return fail("cannot create the folder '" + to.parent_path().string() + "': " + error.message());
    }
    auto partly = UnfinishedFolder::create(to.string());
    if (!partly.has_value()) {
        return fail("cannot create a folder in '" + to.parent_path().string() + "'");
    }
    fs::permissions(partly->path(),
                    fs::perms::others_read | fs::perms::others_exec | fs::perms::group_read |
                        fs::perms::group_exec,
                    fs::perm_options::add, error);
    auto files = setup::machine_files(plan);
    if (const auto written = write_generated(partly->path(), files); !written.has_value()) {
        return std::unexpected(written.error());
    }
    files.push_back({ANSWERS_FILE, answers_text(given)});
    if (const auto written = write_files(partly->path(), files); !written.has_value()) {
        return std::unexpected(written.error());
    }
    if (!partly->become_target()) {
        return fail("cannot create '" + to.string() + "': " + std::strerror(errno));
    }
    return NewMachine{(to / setup::INI_FILE).string(), (to / setup::PROGRAM_FILE).string()};
}

Result<Trial> try_machine(const NewMachine &machine) {
    Child child;
    const auto started =
        child.start({program_folder() + "/millwright", "run", machine.ini, machine.program, "--strict"});
    if (!started.has_value()) {
        return std::unexpected(started.error());
    }
    Trial trial;
    if (!child.read_to_end(trial.output)) {
        return fail("the test run of " + machine.ini + " did not end: " + printable(trial.output));
    }
    trial.good = child.hasSucceeded();
    return trial;
}

}  // namespace mw::programs
