// SPDX-License-Identifier: GPL-2.0-or-later
// A first program, and a tool table with the tool of that program.
#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "machine/setup/files.hh"

namespace mw::setup {
namespace {

/// Positions of an axis as fractions of its travel.
class Places {
  public:
    explicit Places(const Plan &plan) : plan_(plan) {}

    std::string at(char letter, double part) const {
        const Axis &axis = axis_of(letter);
        return letter + number(axis.min + part * (axis.max - axis.min));
    }
    double length(char letter) const { return axis_of(letter).max - axis_of(letter).min; }
    std::string number(double value) const { return fmt::format("{:.{}f}", value, plan_.metric ? 2 : 3); }
    /// [units/min]
    std::string feed() const {
        constexpr double PART = 0.8, S_PER_MIN = 60;
        double slowest = plan_.fastest();
        for (const Axis &axis : plan_.axes) {
            slowest = axis.isRotary() ? slowest : std::min(slowest, axis.speed);
        }
        return "F" + number(slowest * PART * S_PER_MIN);
    }

  private:
    const Axis &axis_of(char letter) const { return *std::ranges::find(plan_.axes, letter, &Axis::letter); }
    const Plan &plan_;
};

/// Moves the rotary axes one after the other, and back.
std::string rotary_moves(const Plan &plan, const Places &p) {
    std::string text;
    for (const Axis &axis : plan.axes) {
        if (axis.isRotary()) {
            text += fmt::format("G0 {}\nG0 {}\n", p.at(axis.letter, 0.6), p.at(axis.letter, 0.5));
        }
    }
    return text;
}

std::string mill_moves(const Places &p) {
    const std::string radius = p.number(std::min(p.length('X'), p.length('Y')) / 16);
    return fmt::format(
        "G0 {0}\nG0 {1} {2}\nG1 {3} {4}\nG1 {5}\nG1 {6}\nG1 {1}\nG1 {2}\nG2 {1} {2} I{7} J0\nG0 {0}\n",
        p.at('Z', 0.9), p.at('X', 0.4), p.at('Y', 0.4), p.at('Z', 0.75), p.feed(), p.at('X', 0.6),
        p.at('Y', 0.6), radius);
}

std::string lathe_moves(const Places &p) {
    return fmt::format("G0 {0} {1}\nG0 {2}\nG1 {3} {4}\nG1 {5} {6}\nG0 {0}\nG0 {1}\n", p.at('X', 0.9),
                       p.at('Z', 0.9), p.at('X', 0.6), p.at('Z', 0.8), p.feed(), p.at('X', 0.7),
                       p.at('Z', 0.7));
}

std::string foam_moves(const Places &p) {
    return fmt::format("G0 {0} {1} {2} {3}\nG1 {4} {5} {6} {7} {8}\nG1 {9} {10}\nG1 {0} {2}\nG1 {1} {3}\n",
                       p.at('X', 0.4), p.at('Y', 0.4), p.at('U', 0.4), p.at('V', 0.4), p.at('X', 0.5),
                       p.at('Y', 0.5), p.at('U', 0.55), p.at('V', 0.45), p.feed(), p.at('X', 0.6),
                       p.at('U', 0.6));
}

}  // namespace

std::string program_text(const Plan &plan) {
    const Places places(plan);
    const bool is_lathe = plan.kind == "lathe", is_foam = plan.kind == "foam";
    std::string text =
        "; SPDX-License-Identifier: GPL-2.0-or-later\n"
        "; A first program: it moves each axis through the middle of its travel, in the air. It counts on\n"
        "; work offsets that are 0.\n";
    text += fmt::format("{} G90 G94 G40 G49 {} G64 P{}\n", plan.metric ? "G21" : "G20",
                        is_lathe ? "G18 G8" : "G17", plan.metric ? "0.05" : "0.002");
    text += is_foam || plan.kind == "plasma" ? "" : "T1 M6\n";
    if (plan.spindle != Spindle::NONE) {
        const double speed = plan.spindle == Spindle::SPEED ? plan.spindle_max / 4 : 1000;
        text += fmt::format("M3 S{:.0f}\n", speed);
    }
    text += is_lathe  ? lathe_moves(places)
            : is_foam ? foam_moves(places)
                      : mill_moves(places) + rotary_moves(plan, places);
    return text + (plan.spindle != Spindle::NONE ? "M5\n" : "") + "M2\n";
}

std::string tool_table_text(const Plan &plan) {
    if (plan.kind == "foam") {
        return "; Tools: a hot wire needs none.\n";
    }
    const std::string diameter = to_text(plan.metric ? 6 : 0.25);
    return fmt::format(
        "; Tools: number, pocket, diameter, length, remark. Measure the length before you cut.\n"
        "T1 P1 D{}{} ;first tool\n",
        plan.kind == "lathe" ? "0" : diameter, plan.kind == "lathe" ? " X+0 Z+0 I+85 J+25 Q2" : " Z+0");
}

}  // namespace mw::setup
