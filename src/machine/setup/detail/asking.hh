// SPDX-License-Identifier: GPL-2.0-or-later
// Collects the questions of a machine.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "machine/setup/questions.hh"

namespace mw::setup::detail {

/// Presets of an axis, in mm or degrees. Machines in inches use 1/25 of lengths, also a round number.
struct AxisPreset {
    char letter;
    double min, max, speed, acceleration;
};

struct Kind {
    std::string_view name, axes;
    double travel_per_turn;  ///< travel per motor revolution [mm]
    std::array<AxisPreset, 5> presets;
};

const Kind &kind_of(const Answers &given);
/// Names of a machine type and all types after it.
std::vector<std::string> kind_names();

constexpr double SHORTEST = 0.001, LONGEST = 100000;

class Asking {
  public:
    Asking(const Answers &given, const Kind &kind) : given_(given), kind_(kind) {}

    std::vector<Question> all();

  private:
    bool isChosen(std::string_view key, std::string_view what) const {
        return answer_of(asked_, given_, key) == what;
    }
    bool isAsked(std::string_view key) const;
    bool isPlasma() const { return kind_.name == "plasma"; }
    bool isFoam() const { return kind_.name == "foam"; }

    void choice(std::string key, std::string text, std::vector<std::string> choices, std::string reason);
    void number(std::string key, std::string text, double preset, const char *unit, std::string reason);
    /// Sets the limits of the last question.
    void within(double low, double high);
    void whole(std::string key, std::string text, int preset, const char *unit, std::string reason);
    void text(std::string key, std::string text, std::string preset, std::string reason);
    double length(double mm) const { return metric_ ? mm : mm / MM_PER_UNIT_OF_PRESETS; }
    const char *unit() const { return metric_ ? "mm" : "in"; }

    // questions.cc
    void general();
    void board();
    void spindle();
    void axis(const AxisPreset &preset);
    void homing(const AxisPreset &preset);
    // questions_wiring.cc
    void timing();
    void motors();
    void motor(const std::string &name);
    void transmission(const std::string &name);
    void servo(const std::string &name);
    void connections(const std::string &name);
    void terminals();
    void spindle_terminals();
    void signals();
    int next_output();
    int next_input();
    bool isPort() const { return isChosen("board", "parport"); }
    int none() const { return isPort() ? 0 : -1; }
    int most_terminals(bool isInput) const;

    static constexpr double MM_PER_UNIT_OF_PRESETS = 25;

    const Answers &given_;
    const Kind &kind_;
    bool metric_ = true;
    int outputs_used_ = 0, inputs_used_ = 0;
    std::vector<Question> asked_;
};

}  // namespace mw::setup::detail
