// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/modules/resolver.hh"

#include <cmath>

#include "drivers/mesa/board/clock.hh"

namespace mw::mesa::board {

namespace {

enum : unsigned { COMMAND, DATA, STATUS, VELOCITY, POSITION };
constexpr std::uint32_t SET_EXCITATION = 0x800, EXCITATION_MASK = 3;
constexpr std::uint32_t DIVIDERS[] = {0, 20'000, 10'000, 5'000};
constexpr std::int64_t COMMAND_NS = 50'000;
constexpr double FULL_REV = 4294967296.0;

/// The fractional revolution as a register.
std::uint32_t fraction_register(double rev) {
    return static_cast<std::uint32_t>(
        static_cast<std::int64_t>(std::floor((rev - std::floor(rev)) * FULL_REV)));
}

}  // namespace

std::int64_t ResolverModule::excitation_period_ns() const {
    return time_of_tick(divider_, clock_hz_);
}

void ResolverModule::sample() {
    const std::int64_t span_ns = time_ns_ - sampled_ns_;
    if (!angle_ || span_ns < excitation_period_ns()) {
        return;
    }
    const double periods = static_cast<double>(span_ns) / static_cast<double>(excitation_period_ns());
    for (unsigned i = 0; i < RESOLVER_CHANNELS; ++i) {
        const auto rev = angle_(i);
        const bool hadSignal = ((status_ >> i) & 1U) == 0;
        status_ = (status_ & ~(1U << i)) | (rev.has_value() ? 0U : 1U << i);
        if (!rev.has_value()) {
            continue;
        }
        const double per_period = hadSignal ? (*rev - channels_[i].rev) / periods : 0.0;
        channels_[i] = {.rev = *rev,
                        .position = fraction_register(*rev),
                        .velocity = static_cast<std::uint32_t>(std::llround(per_period * FULL_REV))};
    }
    sampled_ns_ = time_ns_;
}

std::uint32_t ResolverModule::read(RegisterPlace place) {
    switch (place.reg) {
    case COMMAND: return time_ns_ < done_ns_ ? command_ : 0;
    case DATA: return data_;
    case STATUS: return status_;
    case VELOCITY: return channels_[place.word].velocity;
    default: return channels_[place.word].position;
    }
}

void ResolverModule::write(RegisterPlace place, std::uint32_t value) {
    if (place.reg == DATA) {
        data_ = value;
    } else if (place.reg == COMMAND) {
        command_ = value;
        done_ns_ = time_ns_ + (value == 0 ? 0 : COMMAND_NS);
        if ((value & ~EXCITATION_MASK) == SET_EXCITATION && (value & EXCITATION_MASK) != 0) {
            divider_ = DIVIDERS[value & EXCITATION_MASK];
        }
    }
}

}  // namespace mw::mesa::board
