// SPDX-License-Identifier: GPL-2.0-or-later
#include "commissioning/true_machine.hh"

#include <array>
#include <cmath>
#include <random>

#include <fmt/format.h>

namespace mw::commissioning_campaign {
namespace {

class Maker {
  public:
    explicit Maker(unsigned seed) : random_(seed) { machine_.seed = seed; }

    TrueMachine make() {
        machine_.board = static_cast<Board>(machine_.seed % 3);
        if (machine_.seed >= FIRST_TROUBLE) {
            machine_.trouble = static_cast<Trouble>(1 + (machine_.seed / 3) % 10);
            if (machine_.trouble == Trouble::ENCODER_SWAPPED ||
                machine_.trouble == Trouble::ENCODER_NOT_CONNECTED) {
                machine_.board = Board::MESA_SERVO;
            }
        }
        const bool is_lathe = chance(0.25);
        const char *const kind = is_lathe ? "lathe" : chance(0.5) ? "mill" : "router";
        const std::string letters = is_lathe ? "XZ" : "XYZ";
        answer("kind", kind);
        kind_ = kind;
        answer("drives", machine_.board == Board::MESA_SERVO ? "servo" : "stepper");
        answer("board", machine_.board == Board::PARPORT        ? "parport"
                        : machine_.board == Board::MESA_STEPPER ? "7i76e"
                                                                : "7i97");
        answer("board.simulated", "no");
        answer("switches", "home");
        answer("switch.contacts", chance(0.5) ? "open" : "closed");
        answer("probe.contacts", chance(0.5) ? "open" : "closed");
        answer("pin.probe", machine_.board == Board::PARPORT ? "15" : "9");
        for (const char letter : letters) {
            axis(letter, is_lathe);
        }
        machine_.spindle_full_rpm = 12000 * between(0.7, 1.5);
        machine_.isProbeOpening = chance(0.5);
        machine_.isRaised = machine_.seed % 5 == 0;
        machine_.trouble_axis = random_() % machine_.axes.size();
        if (machine_.trouble == Trouble::ENCODER_SWAPPED) {
            TrueAxis &axis = machine_.axes[machine_.trouble_axis];
            axis.travel_per_rev = -std::abs(axis.travel_per_rev);
        }
        return machine_;
    }

  private:
    bool chance(double part) { return between(0, 1) < part; }
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max());
    }
    void answer(const std::string &key, const std::string &value) { machine_.answers[key] = value; }

    /// The usual error of the first values: another screw, other microsteps, or a small deviation.
    double factor() {
        constexpr std::array USUAL{0.5, 2.0, 0.4, 1.6, 1.27};
        return chance(0.4) ? USUAL[random_() % USUAL.size()] : between(0.85, 1.18);
    }

    void axis(char letter, bool is_lathe) {
        const std::string key(1, static_cast<char>(letter + 'a' - 'A'));
        TrueAxis axis{.letter = letter};
        const double believed_travel = is_lathe || letter == 'Z' ? 5 : 8;
        const double believed_length = std::round(between(120, 300));
        const double lower = letter == 'Z' ? -believed_length : 0;
        answer(key + ".min", fmt::format("{}", lower));
        answer(key + ".max", fmt::format("{}", lower + believed_length));
        answer(key + ".way_per_turn", fmt::format("{}", believed_travel));
        axis.travel_per_rev = believed_travel * factor() * (chance(0.5) ? -1 : 1);
        axis.steps_per_rev = 800;
        axis.backlash = chance(0.3) ? 0 : between(0.01, 0.12);
        const bool at_max = letter == 'Z' || is_lathe;
        const double length = believed_length * between(0.8, 1.2);
        // In a coordinate system with an arbitrary zero.
        axis.lower_end = between(-500, 500);
        axis.upper_end = axis.lower_end + length;
        axis.switch_above = at_max;
        axis.switch_at = at_max ? axis.upper_end - between(4, 8) : axis.lower_end + between(4, 8);
        axis.start = axis.lower_end + length * between(0.45, 0.55);
        axis.isContactOpening = chance(0.5);
        const double believed_speed = kind_ == "router" ? 80 : 40;
        axis.peak_acceleration = between(900, 4000);
        axis.fastest = believed_speed * between(1.6, 4);
        axis.full_rev_s = 50 * between(0.75, 1.3) * (chance(0.5) ? -1 : 1);
        axis.lag_s = between(0.003, 0.02);
        machine_.axes.push_back(axis);
    }

    std::mt19937 random_;
    std::string kind_;
    TrueMachine machine_;
};

}  // namespace

TrueMachine make_true_machine(unsigned seed) {
    return Maker(seed).make();
}

const char *trouble_name(Trouble trouble) {
    switch (trouble) {
    case Trouble::NONE: return "";
    case Trouble::MOTOR_NOT_CONNECTED: return "motor not connected";
    case Trouble::SWITCH_NOT_CONNECTED: return "switch not connected";
    case Trouble::ESTOP_NORMALLY_OPEN: return "emergency stop wired normally open";
    case Trouble::ENCODER_SWAPPED: return "encoder phases swapped";
    case Trouble::NOISE: return "noise on an input";
    case Trouble::LATE_THREAD: return "late thread";
    case Trouble::SWITCHES_EXCHANGED: return "switch at another input";
    case Trouble::ESTOP_NOT_CONNECTED: return "emergency stop not connected";
    case Trouble::PROBE_NOT_CONNECTED: return "probe not connected";
    case Trouble::ENCODER_NOT_CONNECTED: return "encoder not connected";
    }
    return "";
}

}  // namespace mw::commissioning_campaign
