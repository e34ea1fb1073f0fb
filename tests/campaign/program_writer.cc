// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/program_writer.hh"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace mw::campaign {

double to_grid(double x) {
    return std::round(x * 1e4) / 1e4;
}

std::vector<Block> Writer::write(double seconds) {
    say("G21 G90 G17 G94 G80 G40");
    set_mode();
    if (isAdaptive_) {
        say("M52 P1");
    }
    move_to_start();
    if (random_.chance(0.3)) {
        spindle();
    }
    double expected = 0;
    const int most = random_.whole(8, 60);
    for (int n = 0; n < most && expected < seconds; ++n) {
        if (random_.chance(0.06)) {
            set_mode();
        }
        if (random_.chance(0.08)) {
            output();
        }
        expected += random_.chance(0.3) && hasAxis(geometry::AXIS_Y) ? arc() : line();
    }
    say("M63 P0");
    if (isAdaptive_) {
        say("M52 P0");
    }
    say("M2");
    return std::move(blocks_);
}

bool Writer::hasAxis(int axis) const {
    return std::ranges::any_of(design_.axes, [&](const AxisDesign &a) { return a.axis == axis; });
}

const AxisDesign &Writer::axis(int letter) const {
    return *std::ranges::find_if(design_.axes, [&](const AxisDesign &a) { return a.axis == letter; });
}

void Writer::say(const std::string &text) {
    Block b;
    b.text = text;
    blocks_.push_back(b);
}

void Writer::set_mode() {
    const int kind = random_.whole(0, 9);
    settings_.mode = kind == 0   ? geometry::PathMode::EXACT_STOP
                     : kind == 1 ? geometry::PathMode::EXACT_PATH
                                 : geometry::PathMode::BLEND;
    settings_.tolerance = to_grid(std::pow(10.0, random_.real(-1.5, -0.2)));
    settings_.naivecam_tolerance = 0;
    if (kind > 1) {
        say(fmt::format("G64 P{:.4f}", settings_.tolerance));
    } else {
        say(kind == 0 ? "G61.1" : "G61");
        settings_.tolerance = 0;
    }
}

void Writer::spindle() {
    Block b;
    b.text = fmt::format("M3 S{}", random_.whole(100, 3000));
    blocks_.push_back(b);
    b.text = "G4 P0.6";
    b.dwell_s = 0.6;
    blocks_.push_back(b);
}

bool Writer::allow_waits() {
    mayWait_ = random_.chance(0.2);
    isAdaptive_ = random_.chance(0.2);
    return mayWait_;
}

void Writer::output() {
    if (mayWait_) {
        const int kind = random_.whole(0, 4);  // at once, rise, fall, high, low
        say(kind == 0 ? "M66 P0 L0" : fmt::format("M66 P0 L{} Q5", kind));
    }
    say(random_.chance(0.5) ? "M62 P0" : "M63 P0");
    if (random_.chance(0.2)) {
        Block b;
        b.text = fmt::format("M64 P{}", random_.whole(1, 2));
        b.isTimed = false;  // motion comes to a stop
        blocks_.push_back(b);
    }
}

/// A position within the soft limits, with clearance for the joints of other kinematics.
double Writer::place(const AxisDesign &a) {
    if (a.low > 0 || a.high < 0) {
        return to_grid(a.low + random_.real(0.05, 0.95) * (a.high - a.low));
    }
    return to_grid(random_.real(0.9 * a.low, 0.9 * a.high));
}
void Writer::move_to_start() {
    std::string text = "G0";
    for (const AxisDesign &a : design_.axes) {
        at_[a.axis] = to_grid((a.low > 0 || a.high < 0 ? 1 : 0.5) * place(a));
        text += fmt::format(" {}{:.4f}", geometry::AXIS_LETTERS[a.axis], at_[a.axis]);
    }
    push(text, true);
}

void Writer::push(const std::string &text, bool isRapid) {
    Block b;
    b.text = text;
    b.isMove = true;
    b.end = at_;
    b.settings = settings_;
    b.settings.isRapid = isRapid;
    b.settings.feed = isRapid ? 0 : feed_ / 60;
    blocks_.push_back(b);
}

std::string Writer::feed_word() {
    feed_ = std::round(std::pow(10.0, random_.real(2.3, 4.1)));
    return fmt::format(" F{:.0f}", feed_);
}

/// The duration of the move at its feed.
double Writer::line() {
    const geometry::Pose from = at_;
    const double size = std::pow(10.0, random_.real(-1, 0));
    std::string words;
    for (const AxisDesign &a : design_.axes) {
        if (random_.chance(0.6)) {
            at_[a.axis] = to_grid(at_[a.axis] + size * (place(a) - at_[a.axis]));
            words += fmt::format(" {}{:.4f}", geometry::AXIS_LETTERS[a.axis], at_[a.axis]);
        }
    }
    if (words.empty()) {
        return 0;
    }
    const bool isRapid = random_.chance(0.2);
    push((isRapid ? "G0" : "G1") + words + (isRapid ? std::string() : feed_word()), isRapid);
    const geometry::Pose way = at_ - from;
    double length = geometry::norm_linear(way);
    length = length > 0 ? length : geometry::norm_abc(way);
    return isRapid ? length / design_.velocity : length / (feed_ / 60);
}

double Writer::arc() {
    const AxisDesign &x = axis(geometry::AXIS_X);
    const AxisDesign &y = axis(geometry::AXIS_Y);
    const double room = 0.9 * std::min({x.high - at_[0], at_[0] - x.low, y.high - at_[1], at_[1] - y.low});
    if (room < 1) {
        return 0;
    }
    const double radius = 0.5 * room * std::pow(10.0, random_.real(-1.5, 0));
    const double phase = random_.real(0, 2 * std::numbers::pi);
    const double i = to_grid(-radius * std::cos(phase));
    const double j = to_grid(-radius * std::sin(phase));
    const bool isLeft = random_.chance(0.5);
    const double angle = random_.real(0.2, 5.8) * (isLeft ? 1 : -1);
    const double from = std::atan2(-j, -i);
    geometry::Pose centre = at_;
    centre[0] = at_[0] + i;
    centre[1] = at_[1] + j;
    const double r = std::hypot(i, j);
    const geometry::Pose start = at_;
    at_[0] = to_grid(centre[0] + r * std::cos(from + angle));
    at_[1] = to_grid(centre[1] + r * std::sin(from + angle));
    std::string text = fmt::format("G{} X{:.4f} Y{:.4f}", isLeft ? 3 : 2, at_[0], at_[1]);
    if (random_.chance(0.3)) {
        const AxisDesign &z = axis(geometry::AXIS_Z);
        at_[2] = to_grid(at_[2] + 0.2 * (place(z) - at_[2]));
        text += fmt::format(" Z{:.4f}", at_[2]);
    }
    push(text + fmt::format(" I{:.4f} J{:.4f}", i, j) + feed_word(), false);
    Block &b = blocks_.back();
    b.isArc = true;
    b.centre = centre;
    // The tolerance follows from the rounded end point.
    const double to = std::atan2(at_[1] - centre[1], at_[0] - centre[0]);
    const double turn = 2 * std::numbers::pi;
    double swept = std::remainder(to - from - angle, turn) + angle;
    b.angle_rad = swept;
    return std::hypot(r * angle, at_[2] - start[2]) / (feed_ / 60);
}

}  // namespace mw::campaign
