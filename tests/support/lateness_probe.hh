// SPDX-License-Identifier: GPL-2.0-or-later
// Detects whether the processors were busy with other work during a time measurement, on this computer or on
// the host of a virtual machine. Such a measurement is not valid.
#pragma once

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace mw::testing {

/// From its construction until the query, a thread on every processor wakes each millisecond.
class LatenessProbe {
  public:
    LatenessProbe() : stolen_before_(stolen_ticks()), waited_before_us_(waited_us()) {
        const unsigned count = std::max(1U, std::thread::hardware_concurrency());
        for (unsigned i = 0; i < count; ++i) {
            threads_.emplace_back([this] { watch(); });
        }
    }

    /// True if no wake-up was late by 10 ms, no program waited this long for a processor, and no host took
    /// this much time. Ends the measurement.
    bool isCalm() { return lateness_s() < 0.01; }

  private:
    double lateness_s() {
        isDone_ = true;
        threads_.clear();
        constexpr double TICK_S = 0.01;
        return std::max({static_cast<double>(worst_ns_) * 1e-9,
                         static_cast<double>(waited_us() - waited_before_us_) * 1e-6,
                         static_cast<double>(stolen_ticks() - stolen_before_) * TICK_S});
    }

    void watch() {
        using Clock = std::chrono::steady_clock;
        constexpr std::chrono::milliseconds PERIOD{1};
        while (!isDone_) {
            const auto due = Clock::now() + PERIOD;
            std::this_thread::sleep_until(due);
            const std::int64_t late = std::chrono::nanoseconds(Clock::now() - due).count();
            std::int64_t worst = worst_ns_;
            while (late > worst && !worst_ns_.compare_exchange_weak(worst, late)) {
            }
        }
    }

    /// Time of all processors since the start of the machine; proc_stat(5), "steal".
    static std::int64_t stolen_ticks() {
        std::ifstream stat("/proc/stat");
        std::string name;
        std::int64_t ticks[8] = {};
        stat >> name;
        for (std::int64_t &value : ticks) {
            stat >> value;
        }
        return ticks[7];
    }

    /// Time in which some program waited for a processor; the kernel's accounting/psi.rst, "some". 0 if the
    /// kernel does not count it.
    static std::int64_t waited_us() {
        std::ifstream pressure("/proc/pressure/cpu");
        std::string word;
        std::int64_t total = 0;
        while (pressure >> word) {
            if (word.starts_with("total=")) {
                std::from_chars(word.data() + 6, word.data() + word.size(), total);
                break;
            }
        }
        return total;
    }

    std::atomic<bool> isDone_{false};
    std::atomic<std::int64_t> worst_ns_{0};
    std::int64_t stolen_before_;
    std::int64_t waited_before_us_;
    std::vector<std::jthread> threads_;  // last, because they use the members above
};

}  // namespace mw::testing
