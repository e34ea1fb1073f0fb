// SPDX-License-Identifier: GPL-2.0-or-later
#include "runtime/process.hh"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "runtime/activity.hh"

namespace mw::runtime {
namespace {

struct Seen {
    char state = 'X';
    std::uint64_t start_time = 0;  ///< 0 when it is gone, or cannot be read
};

/// The state of a process that exists and whose state cannot be read.
constexpr char UNKNOWN = '?';

/// Source: man 5 proc, /proc/PID/stat, fields 3 and 22.
Seen look_at(std::int32_t pid) {
    char path[64];
    std::snprintf(path, sizeof path, "/proc/%d/stat", pid);
    std::FILE *file = std::fopen(path, "re");
    if (file == nullptr) {
        // Without a free descriptor or memory nothing is known of it: only the kernel's own answer counts.
        const bool isGone = errno == ENOENT || errno == ESRCH || (::kill(pid, 0) != 0 && errno == ESRCH);
        return isGone ? Seen{} : Seen{UNKNOWN, 0};
    }
    char text[1024];
    const std::size_t length = std::fread(text, 1, sizeof text - 1, file);
    std::fclose(file);
    text[length] = '\0';
    // The name in parentheses may hold anything, so count from the last one.
    const char *at = std::strrchr(text, ')');
    if (at == nullptr || at[1] == '\0' || at[2] == 'Z' || at[2] == 'X') {
        return {};
    }
    const char state = at[2];
    ++at;
    constexpr int FIELDS_TO_SKIP = 19;  // 3..21; `at` is at the blank before each
    for (int i = 0; i < FIELDS_TO_SKIP && at != nullptr; ++i) {
        at = std::strchr(at + 1, ' ');
    }
    return at == nullptr ? Seen{} : Seen{state, std::strtoull(at + 1, nullptr, 10)};
}

}  // namespace

ProcessId this_process() {
    const auto pid = static_cast<std::int32_t>(::getpid());
    return {pid, look_at(pid).start_time};
}

Activity activity_of(const ProcessId &process) {
    const Seen seen = process.pid > 0 && process.start_time != 0 ? look_at(process.pid) : Seen{};
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
        return fail("runtime folder " + folder + " must be a folder of this user that nobody else may enter",
                    {}, "remove it, or set XDG_RUNTIME_DIR");
    }
    return folder;
}

}  // namespace mw::runtime
