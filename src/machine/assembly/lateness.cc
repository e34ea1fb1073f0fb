// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/assembly/lateness.hh"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

#include <fmt/format.h>

namespace mw::machine {

std::optional<std::string> why_late(const ThreadTimes &before, const ThreadTimes &now) {
    constexpr double S_PER_NS = 1e-9;
    const std::int64_t gap_ns = now.clock_ns - before.clock_ns;
    if (before.clock_ns == 0 || gap_ns < LATE_NS) {
        return std::nullopt;
    }
    const std::int64_t ran_ns = now.ran_ns - before.ran_ns;
    const std::int64_t waited_ns = now.waited_ns - before.waited_ns;
    const char *why = "it was stopped (by a signal or a debugger), or waited for a disk";
    if (waited_ns >= gap_ns / 2) {
        why = "other programs kept the processors busy: run fewer programs on this computer, or run them "
              "with 'nice'";
    } else if (ran_ns >= gap_ns / 2) {
        why = "it was calculating";
    }
    return fmt::format("task (millwright start) did not run for {:.2f} s: {}",
                       static_cast<double>(gap_ns) * S_PER_NS, why);
}

Lateness::~Lateness() {
    for (const int file : files_) {
        ::close(file);
    }
}

void Lateness::watch(int thread_id) {
    const std::string path = fmt::format("/proc/self/task/{}/schedstat", thread_id);
    if (const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC); file >= 0) {
        files_.push_back(file);
    }
}

std::optional<std::string> Lateness::step(std::int64_t clock_ns) {
    ThreadTimes now{clock_ns, 0, 0};
    for (const int file : files_) {
        std::array<char, 128> text{};
        if (::pread(file, text.data(), text.size() - 1, 0) > 0) {
            char *rest = nullptr;
            now.ran_ns += std::strtoll(text.data(), &rest, 10);
            now.waited_ns += std::strtoll(rest, nullptr, 10);
        }
    }
    const ThreadTimes before = std::exchange(last_, now);
    return why_late(before, now);
}

}  // namespace mw::machine
