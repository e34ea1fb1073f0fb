// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/encoder/encoder_core.hh"

#include <cmath>

namespace mw::encoder {

namespace {

constexpr double SECONDS_PER_UNIT = static_cast<double>(Stamp::TIME_UNIT_NS) * 1e-9;
/// A pause this much longer than the tooth before it is a gap.
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
    if (settings.isCounter) {
        return phases.a && !last_.a ? 1 : 0;
    }
    const int change = quadrature_change(pair_of(last_), pair_of(phases));
    if (settings.isX4) {
        return change;
    }
    // Once per cycle: at the edges of A while B is low.
    const bool isAtEdge = phases.a != last_.a && !phases.b && !last_.b;
    return isAtEdge ? change : 0;
}

bool FastPart::isIndex(const Phases &phases, const FastSettings &settings, int change) noexcept {
    const bool usesGap = settings.isCounter && settings.missing_teeth > 0;
    if (!usesGap) {
        return phases.z && !last_.z;
    }
    if (change == 0) {
        return false;
    }
    const std::int64_t interval = now_ns_ - last_tooth_ns_;
    const bool isGap = tooth_interval_ns_ > 0 &&
                       static_cast<double>(interval) > GAP_FACTOR * static_cast<double>(tooth_interval_ns_);
    last_tooth_ns_ = now_ns_;
    if (!isGap && hasTooth_) {
        tooth_interval_ns_ = interval;
    }
    hasTooth_ = true;
    if (isGap) {
        raw_ = plus(raw_, settings.missing_teeth);
    }
    return isGap;
}

void FastPart::run(const Phases &phases, const FastSettings &settings, std::int64_t period_ns) noexcept {
    now_ns_ += period_ns;
    const auto time = static_cast<std::uint32_t>(now_ns_ / Stamp::TIME_UNIT_NS);
    const int change = change_of(phases, settings);
    raw_ = plus(raw_, change);
    const bool hasIndex = isIndex(phases, settings, change);
    if (change != 0) {
        latest_.store(Stamp{raw_, time}.pack(), std::memory_order_relaxed);
    }
    if (hasIndex && settings.isIndexEnabled && index_.load(std::memory_order_relaxed) == 0) {
        const std::uint64_t count = static_cast<std::uint32_t>(raw_);
        index_.store((count << 1U) | 1U, std::memory_order_relaxed);
    }
    const bool isLatchEdge =
        phases.latch != last_.latch && (phases.latch ? settings.latchRising : settings.latchFalling);
    if (isLatchEdge) {
        latched_.store(raw_, std::memory_order_relaxed);
    }
    time_.store(time, std::memory_order_relaxed);
    last_ = phases;
}

double SlowPart::velocity_of(const Stamp &latest, std::uint32_t now, const Settings &settings) noexcept {
    const std::int32_t counts = minus(latest.count, last_.count);
    if (counts != 0) {
        const double seconds = static_cast<double>(latest.time - last_.time) * SECONDS_PER_UNIT;
        // The first count after standing still, or after a turn of direction, says nothing about the speed.
        const bool isForward = counts > 0;
        const bool goesOn = hasMoved_ && isForward == isForward_;
        velocity_ = goesOn && seconds > 0.0 ? counts / seconds : 0.0;
        hasMoved_ = true;
        isForward_ = isForward;
        last_ = latest;
    } else if (hasMoved_) {
        // No count since: not faster than one count in the time that has passed.
        const double seconds = static_cast<double>(now - last_.time) * SECONDS_PER_UNIT;
        const double most = seconds > 0.0 ? 1.0 / seconds : std::fabs(velocity_);
        if (std::fabs(velocity_) > most) {
            velocity_ = std::copysign(most, velocity_);
        }
        if (most < std::fabs(settings.min_speed * settings.scale)) {
            velocity_ = 0.0;
            hasMoved_ = false;
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
