// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/files/filter.hh"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/temporary_file.hh"
#include "base/text.hh"
#include "clients/screen/files/files.hh"
#include "clients/screen/http/json_text.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t MOST_TOLD = 2000;  ///< maximum size of the stderr output [bytes]

/// Report of a filter: its progress, or its result.
std::string filter_progress_text(int percent) {
    return member_text("progress", percent) + '\n';
}

std::string filter_made_text(std::string_view path) {
    return member_text("made", std::string(path)) + '\n';
}

std::string filter_error_text(std::string_view why) {
    return member_text("error", std::string(why)) + '\n';
}

std::string last_error() {
    return std::strerror(errno);
}

/// A program in a separate process group, so that its children end with it.
class Child {
  public:
    /// Its output is written to `output`.
    Result<> start(const FilterRun &run, int output) {
        std::array<int, 2> ends{-1, -1};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
            return fail(last_error());
        }
        errors_ = ends[0];
        posix_spawn_file_actions_t actions;
        posix_spawnattr_t attributes;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawnattr_init(&attributes);
        ::posix_spawn_file_actions_addchdir_np(&actions, run.folder.c_str());
        ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
        sigset_t all, none;
        ::sigfillset(&all);
        ::sigemptyset(&none);
        ::posix_spawnattr_setsigdefault(&attributes, &all);
        ::posix_spawnattr_setsigmask(&attributes, &none);
        ::posix_spawnattr_setpgroup(&attributes, 0);
        ::posix_spawnattr_setflags(&attributes,
                                   POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
        std::array<std::string, 5> words{"/bin/sh", "-c", run.command + " \"$1\"", "filter", run.input};
        std::array<char *, 6> argv{};
        std::ranges::transform(words, argv.begin(), [](std::string &word) { return word.data(); });
        std::string mark = "AXIS_PROGRESS_BAR=1";  // indicates to filters that progress is displayed
        std::vector<char *> environment{mark.data()};
        for (char **one = environ; *one != nullptr; ++one) {
            environment.push_back(*one);
        }
        environment.push_back(nullptr);
        const int failed =
            ::posix_spawn(&pid_, argv[0], &actions, &attributes, argv.data(), environment.data());
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
        ::close(ends[1]);
        if (failed != 0) {
            pid_ = 0;
            return fail(std::strerror(failed));
        }
        return {};
    }
    Child() = default;
    Child(const Child &) = delete;
    Child &operator=(const Child &) = delete;
    ~Child() {
        signal_all(SIGKILL);
        if (pid_ != 0 && !ended_) {
            ::waitpid(pid_, nullptr, 0);
        }
        if (errors_ >= 0) {
            ::close(errors_);
        }
    }
    void signal_all(int number) const {
        if (pid_ > 0) {
            ::kill(-pid_, number);
        }
    }
    /// Its stderr output; waits at most 50 ms.
    std::string listen() {
        constexpr int WAIT_MS = 50;
        pollfd look{errors_, POLLIN, 0};
        std::array<char, 4096> bytes{};
        if (errors_ < 0) {
            ::poll(nullptr, 0, WAIT_MS);
        } else if (::poll(&look, 1, WAIT_MS) > 0) {
            const ssize_t count = ::read(errors_, bytes.data(), bytes.size());
            if (count > 0) {
                return {bytes.data(), static_cast<std::size_t>(count)};
            }
            if (count == 0) {
                ::close(errors_);
                errors_ = -1;
            }
        }
        return {};
    }
    /// Its status from waitpid(); nothing while it runs.
    std::optional<int> end() {
        int status = 0;
        if (!ended_ && ::waitpid(pid_, &status, WNOHANG) == pid_) {
            ended_ = true;
            status_ = status;
        }
        return ended_ ? std::optional(status_) : std::nullopt;
    }

  private:
    pid_t pid_ = 0;
    int errors_ = -1;
    bool ended_ = false;
    int status_ = 0;
};

/// Lines of stderr: progress, or messages.
class Told {
  public:
    Told(PieceQueue &pieces) : pieces_(pieces) {}
    void take(const std::string &bytes) {
        rest_ += bytes;
        for (std::size_t end = rest_.find('\n'); end != std::string::npos; end = rest_.find('\n')) {
            take_line(rest_.substr(0, end));
            rest_.erase(0, end + 1);
        }
        if (rest_.size() > MOST_TOLD) {
            take_line(std::exchange(rest_, {}));
        }
    }
    std::string all() const { return std::string(trim(said_ + rest_)); }

  private:
    void take_line(const std::string &line) {
        constexpr std::string_view PROGRESS = "FILTER_PROGRESS=";
        if (line.starts_with(PROGRESS)) {
            const auto percent = parse_double(trim(line.substr(PROGRESS.size())));
            const int now = percent.has_value() ? static_cast<int>(std::clamp(*percent, 0.0, 100.0)) : shown_;
            if (now != shown_) {
                shown_ = now;
                pieces_.push(filter_progress_text(now));
            }
            return;
        }
        said_ += line + '\n';
        if (said_.size() > MOST_TOLD) {
            said_.erase(0, said_.size() - MOST_TOLD);
        }
    }
    PieceQueue &pieces_;
    std::string rest_, said_;
    int shown_ = -1;
};

std::string how(int status) {
    return WIFEXITED(status) ? fmt::format("has ended with status {}", WEXITSTATUS(status))
                             : fmt::format("was ended by signal {}", WTERMSIG(status));
}

bool isTooLarge(int output) {
    struct stat facts{};
    return ::fstat(output, &facts) == 0 &&
           static_cast<std::uint64_t>(facts.st_size) > ProgramFiles::MOST_BYTES;
}

/// Writes into the open file `output`.
Result<> fill(const FilterRun &run, int output, PieceQueue &pieces) {
    constexpr auto PATIENCE = std::chrono::seconds(1);
    Child child;
    if (const Result<> started = child.start(run, output); !started.has_value()) {
        return fail(
            fmt::format("the filter '{}' cannot be started: {}", run.command, started.error().message));
    }
    Told told(pieces);
    std::optional<Clock::time_point> asked;
    std::optional<int> status;
    while (!status.has_value()) {
        told.take(child.listen());
        status = child.end();
        if (!asked.has_value() && (isTooLarge(output) || pieces.isCancelled())) {
            child.signal_all(SIGTERM);  // ends it, and kills it if it does not end
            asked = Clock::now();
        } else if (asked.has_value() && Clock::now() - *asked > PATIENCE) {
            child.signal_all(SIGKILL);
        }
    }
    for (std::string more = child.listen(); !more.empty(); more = child.listen()) {
        told.take(more);
    }
    if (asked.has_value()) {
        return fail(
            isTooLarge(output)
                ? fmt::format("the filter '{}' was ended: its output exceeds the maximum size of a program",
                              run.command)
                : fmt::format("the filter '{}' was ended: its output is no longer needed", run.command));
    }
    if (*status != 0) {
        return fail(fmt::format("the filter '{}' {}: {}", run.command, how(*status), printable(told.all())));
    }
    struct stat facts{};
    if (::fstat(output, &facts) != 0 || facts.st_size == 0) {
        return fail(
            fmt::format("the filter '{}' produced no program: {}", run.command, printable(told.all())));
    }
    return {};
}

}  // namespace

std::map<std::string, std::string> filters_of(const ini::IniFile &ini) {
    std::map<std::string, std::string> filters;
    for (const ini::IniEntry &entry : ini.entries()) {
        const bool is_filter =
            entry.section == "FILTER" && entry.key != "PROGRAM_EXTENSION" && !trim(entry.value).empty();
        if (is_filter) {
            filters.emplace('.' + to_lower(entry.key), entry.value);
        }
    }
    return filters;
}

std::string filtered_folder(const std::string &instance) {
    const char *cache = std::getenv("XDG_CACHE_HOME");
    const char *home = std::getenv("HOME");
    const bool has_cache = cache != nullptr && *cache == '/';
    const std::string base =
        has_cache ? std::string(cache)
        : home != nullptr && *home == '/'
            ? std::string(home) + "/.cache"
            : fmt::format("{}/millwright-{}", fs::temp_directory_path().string(), ::getuid());
    return base + "/millwright/filtered/" + instance;
}

void run_filter(const FilterRun &run, PieceQueue &pieces) {
    const auto refuse = [&](const std::string &why) { pieces.push(filter_error_text(why)); };
    std::error_code error;
    const fs::path folder = fs::path(run.output).parent_path();
    fs::create_directories(folder, error);
    fs::permissions(folder, fs::perms::owner_all, error);  // so that no other user can put a program there
    if (error) {
        refuse(fmt::format("cannot make '{}' private: {}", folder.string(), error.message()));
        return;
    }
    auto output = TemporaryFile::create(run.output);
    if (!output.has_value()) {
        refuse(fmt::format("cannot write into '{}': {}", folder.string(), last_error()));
        return;
    }
    Result<> made = fill(run, output->fd(), pieces);
    if (made.has_value() && !output->replace_target()) {
        made = fail(fmt::format("cannot write '{}': {}", run.output, last_error()));
    }
    if (!made.has_value()) {
        refuse(made.error().message);
        return;
    }
    pieces.push(filter_made_text(run.output));
}

}  // namespace mw::screen
