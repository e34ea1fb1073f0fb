// SPDX-License-Identifier: GPL-2.0-or-later
// Counting of encoder signals without HAL. A fast part samples the phases; a slow part computes position and
// velocity. They may run in two threads of which the fast one preempts the slow one, so they exchange only
// complete 64-bit words.
#pragma once

#include <atomic>
#include <cstdint>

namespace mw::encoder {

constexpr int MAX_CHANNELS = 8;

/// The change of the count for a quadrature transition of the phases A (bit 1) and B (bit 0). A leads B when
/// counting up. When both phases change at once the direction is unknown, and the result is 0.
inline int quadrature_change(unsigned before, unsigned after) noexcept {
    // Position in the cycle 00 -> 10 -> 11 -> 01.
    constexpr unsigned char CYCLE[4] = {0, 3, 1, 2};
    const unsigned difference = (CYCLE[after & 3U] - CYCLE[before & 3U]) & 3U;
    return difference == 1 ? 1 : (difference == 3 ? -1 : 0);
}

/// A count and the time at which it was reached, packed into one word so that both are read together.
struct Stamp {
    std::int32_t count = 0;
    std::uint32_t time = 0;  ///< [TIME_UNIT_NS], wraps

    static constexpr std::int64_t TIME_UNIT_NS = 100;

    std::uint64_t pack() const noexcept {
        return (std::uint64_t{time} << 32U) | static_cast<std::uint32_t>(count);
    }
    static Stamp unpack(std::uint64_t word) noexcept {
        return {static_cast<std::int32_t>(static_cast<std::uint32_t>(word)),
                static_cast<std::uint32_t>(word >> 32U)};
    }
};

struct Phases {
    bool a = false;
    bool b = false;
    bool z = false;
    bool latch = false;
};

struct FastSettings {
    bool is_counter = false;  ///< count rising edges of A only
    bool is_x4 = true;        ///< otherwise one count per cycle
    bool isIndexEnabled = false;
    bool latchRising = true;
    bool latchFalling = true;
    std::int32_t missing_teeth = 0;  ///< in counter mode: a gap of this many teeth is the index; 0: no index
};

/// Samples the phases. [realtime, the faster thread]
class FastPart {
  public:
    void run(const Phases &phases, const FastSettings &settings, std::int64_t period_ns) noexcept;

    std::int32_t raw() const noexcept { return raw_; }

  private:
    friend class SlowPart;
    int change_of(const Phases &phases, const FastSettings &settings) const noexcept;
    bool isIndex(const Phases &phases, const FastSettings &settings, int change) noexcept;

    Phases last_{.z = true};  // an index signal that is TRUE in the first period is not an edge
    std::int32_t raw_ = 0;
    std::int64_t now_ns_ = 0;
    std::int64_t last_tooth_ns_ = 0;
    std::int64_t tooth_interval_ns_ = 0;  ///< 0: not yet known
    bool has_tooth_ = false;
    // The fast part writes these and the slow part reads them. Each word is complete by itself, so relaxed
    // order is enough.
    std::atomic<std::uint64_t> latest_{0};  ///< Stamp of the last change
    std::atomic<std::uint32_t> time_{0};    ///< the current time, in Stamp units
    std::atomic<std::uint64_t> index_{
        0};  ///< count at the index << 1 | 1; 0: none. Cleared by the slow part.
    std::atomic<std::int32_t> latched_{0};  ///< count at the last edge of the latch input
};

/// The results of one run of the slow part.
struct Measured {
    std::int32_t counts = 0;
    double position = 0.0;
    double interpolated = 0.0;
    double velocity = 0.0;  ///< [units/s]
    std::int32_t counts_latched = 0;
    double position_latched = 0.0;
    bool indexSeen = false;  ///< the index was passed; counting starts there
};

/// Computes position and velocity. [realtime, the slower thread]
class SlowPart {
  public:
    struct Settings {
        double scale = 1.0;      ///< [counts/unit]
        double min_speed = 1.0;  ///< below it velocity is 0 [units/s]
        bool isReset = false;
    };
    Measured run(FastPart &fast, const Settings &settings) noexcept;

  private:
    double velocity_of(const Stamp &latest, std::uint32_t now, const Settings &settings) noexcept;

    std::int32_t offset_ = 0;
    Stamp last_{};
    double velocity_ = 0.0;  ///< [counts/s]
    bool moved_ = false;
    bool forward_ = true;  ///< direction of the last counts
};

}  // namespace mw::encoder
