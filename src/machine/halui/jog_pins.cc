// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/halui/jog_pins.hh"

#include <cmath>
#include <utility>

#include "messages/legacy/units.hh"

namespace mw::halui {
namespace {

constexpr int LEASE_MS = 500;
constexpr std::int64_t RENEWAL_NS = 100000000;

bool isOpposite(double a, double b) {
    return (a > 0) != (b > 0);
}

}  // namespace

double JogPins::part_of(const JogInputs &now, const JogSettings &settings) {
    if (now.is_plus != now.is_minus) {
        return now.is_plus ? 1.0 : -1.0;
    }
    const bool exceeded =
        !now.is_plus && std::isfinite(now.analog) && std::abs(now.analog) > settings.deadband;
    return exceeded ? now.analog : 0.0;
}

std::vector<messages::Command> JogPins::step(const JogInputs &now, const JogSettings &settings,
                                             const Target &target, std::int64_t now_ns) {
    std::vector<messages::Command> asked;
    const double part = part_of(now, settings);
    if (!std::exchange(known_, true)) {
        waiting_ = true;  // a pin that is TRUE at the start has not been pressed
    }
    if (target.index != target_.index && part_ != 0) {
        asked.emplace_back(messages::JogStop{target_.isJoint, target_.index});
        part_ = 0;
        waiting_ = rejected_;
    }
    target_ = target;
    waiting_ = waiting_ && part != 0;
    if (!waiting_) {
        step_held(part, legacy::per_second(std::abs(settings.speed_per_min)), now_ns, asked);
    }
    const bool forward = plus_.step(now.is_increment_plus), returned = minus_.step(now.is_increment_minus);
    if (forward != returned) {
        asked.emplace_back(messages::JogIncrement{target.isJoint, target.index,
                                                  legacy::per_second(std::abs(settings.speed_per_min)),
                                                  forward ? now.increment : -now.increment});
    }
    return asked;
}

void JogPins::step_held(double part, double speed, std::int64_t now_ns,
                        std::vector<messages::Command> &asked) {
    if (part_ != 0 && (part == 0 || isOpposite(part, part_))) {
        asked.emplace_back(messages::JogStop{target_.isJoint, target_.index});
        part_ = 0;
    }
    if (part == 0) {
        return;
    }
    const bool is_new = part_ == 0;
    if (!is_new && part == part_ && now_ns - renewed_ns_ < RENEWAL_NS) {
        return;
    }
    part_ = part;
    rejected_ = rejected_ && !is_new;
    renewed_ns_ = now_ns;
    asked.emplace_back(
        messages::JogContinuous{target_.isJoint, target_.index, part * speed, LEASE_MS, !is_new});
}

}  // namespace mw::halui
