// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/encoder/encoder_core.hh"

#include <cmath>

namespace mw::encoder {

namespace {

constexpr double SECONDS_PER_UNIT = static_cast<double>(Stamp::TIME_UNIT_NS) * 1e-9;
/// A pause longer than the previous tooth by this factor is a gap.
constexpr double GAP_FACTOR = 1.5;

std::int32_t plus(std::int32_t a, std::int32_t b) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

std::int32_t minus(std::int32_t a, std::int32_t b) noexcept {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

unsigned pair_of(const Phases &phases) noexcept {
    return (phases.a ? 2U : 0U) | (phases.b ? 1U : 0U);
}

}  // namespace

int FastPart::change_of(const Phases &phases, const FastSettings &settings) const noexcept {
    if (settings.is_counter) {
        return phases.a && !last_.a ? 1 : 0;
    }
    const int change = quadrature_change(pair_of(last_), pair_of(phases));
    if (settings.is_x4) {
        return change;
    }
    // One count per cycle: at the edges of A while B is low.
    const bool at_edge = phases.a != last_.a && !phases.b && !last_.b;
    return at_edge ? change : 0;
}

bool FastPart::isIndex(const Phases &phases, const FastSettings &settings, int change) noexcept {
    const bool usesGap = settings.is_counter && settings.missing_teeth > 0;
    if (!usesGap) {
        return phases.z && !last_.z;
    }
    if (change == 0) {
        return false;
    }
    const std::int64_t interval = now_ns_ - last_tooth_ns_;
    const bool is_gap = tooth_interval_ns_ > 0 &&
                        static_cast<double>(interval) > GAP_FACTOR * static_cast<double>(tooth_interval_ns_);
    last_tooth_ns_ = now_ns_;
    if (!is_gap && has_tooth_) {
        tooth_interval_ns_ = interval;
    }
    has_tooth_ = true;
    if (is_gap) {
        raw_ = plus(raw_, settings.missing_teeth);
    }
    return is_gap;
}

void FastPart::run(const Phases &phases, const FastSettings &settings, std::int64_t period_ns) noexcept {
    now_ns_ += period_ns;
    const auto time = static_cast<std::uint32_t>(now_ns_ / Stamp::TIME_UNIT_NS);
    const int change = change_of(phases, settings);
    raw_ = plus(raw_, change);
    const bool has_index = isIndex(phases, settings, change);
    if (change != 0) {
        latest_.store(Stamp{raw_, time}.pack(), std::memory_order_relaxed);
    }
    if (has_index && settings.isIndexEnabled && index_.load(std::memory_order_relaxed) == 0) {
        const std::uint64_t count = static_cast<std::uint32_t>(raw_);
        index_.store((count << 1U) | 1U, std::memory_order_relaxed);
    }
    const bool is_latch_edge =
        phases.latch != last_.latch && (phases.latch ? settings.latchRising : settings.latchFalling);
    if (is_latch_edge) {
        latched_.store(raw_, std::memory_order_relaxed);
    }
    time_.store(time, std::memory_order_relaxed);
    last_ = phases;
}

double SlowPart::velocity_of(const Stamp &latest, std::uint32_t now, const Settings &settings) noexcept {
    const std::int32_t counts = minus(latest.count, last_.count);
    if (counts != 0) {
        const double seconds = static_cast<double>(latest.time - last_.time) * SECONDS_PER_UNIT;
        // The first count after standstill or after a change of direction gives no information about the
        // speed.
        const bool forward = counts > 0;
        const bool goesOn = moved_ && forward == forward_;
        velocity_ = goesOn && seconds > 0.0 ? counts / seconds : 0.0;
        moved_ = true;
        forward_ = forward;
        last_ = latest;
    } else if (moved_) {
        // No new count: the speed is at most one count in the elapsed time.
        const double seconds = static_cast<double>(now - last_.time) * SECONDS_PER_UNIT;
        const double most = seconds > 0.0 ? 1.0 / seconds : std::fabs(velocity_);
        if (std::fabs(velocity_) > most) {
            velocity_ = std::copysign(most, velocity_);
        }
        if (most < std::fabs(settings.min_speed * settings.scale)) {
            velocity_ = 0.0;
            moved_ = false;
        }
    }
    return velocity_;
}

Measured SlowPart::run(FastPart &fast, const Settings &settings) noexcept {
    Measured result;
    const Stamp latest = Stamp::unpack(fast.latest_.load(std::memory_order_relaxed));
    const std::uint32_t now = fast.time_.load(std::memory_order_relaxed);
    const std::uint64_t index = fast.index_.exchange(0, std::memory_order_relaxed);
    if (index != 0) {
        offset_ = static_cast<std::int32_t>(static_cast<std::uint32_t>(index >> 1U));
        result.indexSeen = true;
    }
    if (settings.isReset) {
        offset_ = latest.count;
    }
    const double per_count = settings.scale != 0.0 ? 1.0 / settings.scale : 1.0;
    const double velocity = velocity_of(latest, now, settings) * per_count;
    result.velocity = std::fabs(velocity) < settings.min_speed ? 0.0 : velocity;
    result.counts = minus(latest.count, offset_);
    result.position = result.counts * per_count;
    const double since_count = static_cast<double>(now - latest.time) * SECONDS_PER_UNIT;
    result.interpolated = result.position + (result.velocity != 0.0 ? result.velocity * since_count : 0.0);
    result.counts_latched = minus(fast.latched_.load(std::memory_order_relaxed), offset_);
    result.position_latched = result.counts_latched * per_count;
    return result;
}

}  // namespace mw::encoder
