// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/process.hh"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "runtime/activity.hh"

namespace mw::runtime {
namespace {

struct Seen {
    char state = 'X';
    std::uint64_t start_time = 0;  ///< 0 when the process has ended or cannot be read
};

/// State of a process that exists but cannot be read.
constexpr char UNKNOWN = '?';

/// Source: man 5 proc, /proc/PID/stat, fields 3 and 22.
Seen parse(const char *text) {
    // The name in parentheses may contain any character, so count from the last parenthesis.
    const char *at = std::strrchr(text, ')');
    if (at == nullptr || at[1] == '\0' || at[2] == 'Z' || at[2] == 'X') {
        return {};
    }
    const char state = at[2];
    ++at;
    constexpr int FIELDS_TO_SKIP = 19;  // fields 3 to 21; `at` points to the blank before each
    for (int i = 0; i < FIELDS_TO_SKIP && at != nullptr; ++i) {
        at = std::strchr(at + 1, ' ');
    }
    return at == nullptr ? Seen{} : Seen{state, std::strtoull(at + 1, nullptr, 10)};
}

/// Reads an open /proc/PID/stat. The file still refers to its process when the process id is reused.
Seen read_state(int file) {
    char text[1024];
    const ssize_t length = ::pread(file, text, sizeof text - 1, 0);
    if (length <= 0) {
        return {};
    }
    text[length] = '\0';
    return parse(text);
}

/// Returns the descriptor, or -errno.
int open_state(std::int32_t pid) {
    char path[64];
    std::snprintf(path, sizeof path, "/proc/%d/stat", pid);
    const int file = ::open(path, O_RDONLY | O_CLOEXEC);
    return file >= 0 ? file : -errno;
}

/// For a file that cannot be opened. Without a free descriptor or memory only the kernel's own answer is
/// valid.
Seen seen_without_file(std::int32_t pid, int error) {
    const bool gone = error == ENOENT || error == ESRCH || (::kill(pid, 0) != 0 && errno == ESRCH);
    return gone ? Seen{} : Seen{UNKNOWN, 0};
}

/// Open files of processes that a thread checks repeatedly. Opening one in each cycle allocates kernel
/// memory, and the thread waits when its cgroup has none left.
class StateFiles {
  public:
    StateFiles() = default;
    ~StateFiles() {
        for (const Entry &entry : entries_) {
            if (entry.file >= 0) {
                ::close(entry.file);
            }
        }
    }
    StateFiles(const StateFiles &) = delete;
    StateFiles &operator=(const StateFiles &) = delete;

    Seen look_at(const ProcessId &process) {
        Entry *entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry &one) {
            return one.file >= 0 && one.process == process;
        });
        if (entry == entries_.end()) {
            const int file = open_state(process.pid);
            if (file < 0) {
                return seen_without_file(process.pid, -file);
            }
            entry = &entries_[next_];
            next_ = (next_ + 1) % entries_.size();
            forget(*entry);
            *entry = {process, file};
        }
        const Seen seen = read_state(entry->file);
        if (seen.start_time != process.start_time) {
            forget(*entry);
        }
        return seen;
    }

  private:
    struct Entry {
        ProcessId process;
        int file = -1;
    };
    static void forget(Entry &entry) {
        if (entry.file >= 0) {
            ::close(std::exchange(entry.file, -1));
        }
    }

    static constexpr std::size_t MOST = 40;  ///< clients of a machine, and processes of the machine
    std::array<Entry, MOST> entries_{};
    std::size_t next_ = 0;
};

Seen look_at(const ProcessId &process) {
    static thread_local StateFiles files;
    return files.look_at(process);
}

}  // namespace

ProcessId this_process() {
    const auto pid = static_cast<std::int32_t>(::getpid());
    const int file = open_state(pid);
    if (file < 0) {
        return {pid, 0};
    }
    const Seen seen = read_state(file);
    ::close(file);
    return {pid, seen.start_time};
}

Activity activity_of(const ProcessId &process) {
    const Seen seen = process.pid > 0 && process.start_time != 0 ? look_at(process) : Seen{};
    if (seen.state == UNKNOWN) {
        return Activity::RUNNING;
    }
    if (seen.start_time == 0 || seen.start_time != process.start_time) {
        return Activity::ENDED;
    }
    return seen.state == 'T' || seen.state == 't' ? Activity::STOPPED : Activity::RUNNING;
}

bool isAlive(const ProcessId &process) {
    return activity_of(process) != Activity::ENDED;
}

Result<std::string> runtime_folder() {
    const char *base = std::getenv("XDG_RUNTIME_DIR");
    std::string folder = base != nullptr && base[0] == '/' ? std::string(base) + "/millwright"
                                                           : "/tmp/millwright-" + std::to_string(::getuid());
    if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) {
        return fail("runtime folder " + folder + ": " + std::strerror(errno));
    }
    struct stat status{};
    if (::lstat(folder.c_str(), &status) != 0) {
        return fail("runtime folder " + folder + ": " + std::strerror(errno));
    }
    if (!S_ISDIR(status.st_mode) || status.st_uid != ::getuid() || (status.st_mode & 077) != 0) {
        return fail("runtime folder " + folder + " must belong to this user and be closed to other users", {},
                    "remove it, or set XDG_RUNTIME_DIR");
    }
    return folder;
}

}  // namespace mw::runtime
