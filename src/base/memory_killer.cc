// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/memory_killer.hh"

#include <fcntl.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "base/capabilities.hh"

namespace mw {
namespace {

constexpr int HIGHEST = 1000;

std::string file_of(pid_t process) {
    return "/proc/" + (process == 0 ? "self" : std::to_string(process)) + "/oom_score_adj";
}

bool read_score(pid_t process, int &score) {
    const int file = ::open(file_of(process).c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) {
        return false;
    }
    std::array<char, 16> text{};
    const ssize_t size = ::read(file, text.data(), text.size());
    ::close(file);
    return size > 0 && std::from_chars(text.data(), text.data() + size, score).ec == std::errc{};
}

bool write_score(pid_t process, int score) {
    const int file = ::open(file_of(process).c_str(), O_WRONLY | O_CLOEXEC);
    if (file < 0) {
        return false;
    }
    const std::string text = std::to_string(score);
    const bool is_written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    ::close(file);
    return is_written;
}

}  // namespace

bool raise_oom_score(int step, pid_t process) {
    int score = 0;
    return read_score(process, score) && write_score(process, std::min(score + step, HIGHEST));
}

int lower_oom_score(int wanted) {
    int score = 0;
    if (!read_score(0, score)) {
        return score;
    }
    // Files in /proc of a process with file capabilities belong to root while the process is not dumpable.
    const int wasDumpable = ::prctl(PR_GET_DUMPABLE);
    static_cast<void>(::prctl(PR_SET_DUMPABLE, 1));
    // The kernel permits all values from a minimum up: find it by bisection.
    for (int refused = wanted - 1; score - refused > 1;) {
        const int next = (score + refused) / 2;
        (write_score(0, next) ? score : refused) = next;
    }
    if (wasDumpable != 1) {
        static_cast<void>(::prctl(PR_SET_DUMPABLE, 0));
    }
    if (::geteuid() != 0) {
        give_up_capability(CAP_SYS_RESOURCE);  // the capability would also override memory and disk limits
    }
    return score;
}

}  // namespace mw
