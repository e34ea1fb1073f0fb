// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/setup/questions.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.hh"

namespace mw::setup {
namespace {

/// Presets of an axis, in mm. Machines in inches use 1/25 of it, also a round number.
struct Preset {
    char letter;
    double min, max, speed, acceleration;
};

struct Kind {
    std::string_view name, axes;
    double way_per_turn;  ///< of a motor [mm]
    std::array<Preset, 4> presets;
};

constexpr std::array<Kind, 5> ALL{{
    {"mill", "XYZ", 5, {{{'X', 0, 300, 40, 300}, {'Y', 0, 150, 40, 300}, {'Z', -120, 0, 25, 300}, {}}}},
    {"router", "XYZ", 10, {{{'X', 0, 600, 80, 500}, {'Y', 0, 900, 80, 500}, {'Z', -100, 0, 40, 300}, {}}}},
    {"gantry",
     "XYZ",
     10,
     {{{'X', 0, 1000, 100, 500}, {'Y', 0, 1500, 100, 500}, {'Z', -150, 0, 40, 300}, {}}}},
    {"lathe", "XZ", 5, {{{'X', -5, 100, 25, 250}, {'Z', -300, 0, 30, 250}, {}, {}}}},
    {"foam",
     "XYUV",
     5,
     {{{'X', 0, 600, 25, 200}, {'Y', 0, 300, 25, 200}, {'U', 0, 600, 25, 200}, {'V', 0, 300, 25, 200}}}},
}};

constexpr double SHORTEST = 0.001, LONGEST = 100000;
constexpr double MM_PER_UNIT_OF_PRESETS = 25;

const Kind &kind_of(const Answers &given) {
    const auto answer = given.find("kind");
    const std::string_view name = answer == given.end() ? "" : std::string_view(answer->second);
    const auto *const found = std::ranges::find(ALL, name, &Kind::name);
    return found == ALL.end() ? ALL[0] : *found;
}

/// Collects the questions of a machine.
class Asking {
  public:
    Asking(const Answers &given, const Kind &kind) : given_(given), kind_(kind) {}

    std::vector<Question> all() {
        general();
        for (std::size_t i = 0; i < kind_.axes.size(); ++i) {
            axis(kind_.presets.at(i));
        }
        if (isChosen("drives", "stepper")) {
            stepper();
        }
        return std::move(asked_);
    }

  private:
    bool isChosen(std::string_view key, std::string_view what) const {
        return answer_of(asked_, given_, key) == what;
    }
    void choice(std::string key, std::string text, std::vector<std::string> choices) {
        std::string preset = choices[0];
        asked_.push_back(
            {std::move(key), std::move(text), Form::CHOICE, std::move(preset), std::move(choices)});
    }
    void number(std::string key, std::string text, double preset, double low, double high,
                std::string unit = "") {
        asked_.push_back(
            {std::move(key), std::move(text), Form::NUMBER, to_text(preset), {}, low, high, std::move(unit)});
    }
    void whole(std::string key, std::string text, int preset, int low, int high, std::string unit = "") {
        asked_.push_back({std::move(key),
                          std::move(text),
                          Form::WHOLE,
                          std::to_string(preset),
                          {},
                          static_cast<double>(low),
                          static_cast<double>(high),
                          std::move(unit)});
    }
    double length(double mm) const { return metric_ ? mm : mm / MM_PER_UNIT_OF_PRESETS; }
    std::string unit(const char *more = "") const { return (metric_ ? "mm" : "in") + std::string(more); }

    void general();
    void axis(const Preset &preset);
    void stepper();
    void motor(const std::string &name, int &next_output, int &next_input);

    const Answers &given_;
    const Kind &kind_;
    bool metric_ = true;
    std::vector<Question> asked_;
};

void Asking::general() {
    std::vector<std::string> kinds;
    for (const Kind &kind : ALL) {
        kinds.emplace_back(kind.name);
    }
    asked_.push_back({"kind", "Machine type", Form::CHOICE, std::string(kind_.name), std::move(kinds)});
    asked_.push_back({"name", "Machine name", Form::TEXT, "My " + std::string(kind_.name)});
    choice("units", "Length unit", {"mm", "inch"});
    metric_ = isChosen("units", "mm");
    choice("drives", "Motors", {"simulated", "stepper"});
    choice("switches", "Switches", {"none", "home", "home_and_limits"});
    const bool is_foam = kind_.name == "foam";
    choice("spindle", is_foam ? "Hot wire" : "Spindle", {"speed", "on_off", "none"});
    if (isChosen("spindle", "speed")) {
        number("spindle.max", is_foam ? "S word of full heat" : "Maximum spindle speed",
               is_foam ? 100 : 12000, 1, 1000000, is_foam ? "" : "rev/min");
    }
    choice("tool_change", "Tool change",
           is_foam ? std::vector<std::string>{"none", "by_hand"}
                   : std::vector<std::string>{"by_hand", "none"});
    if (is_foam) {
        number("foam.width", "From the plane of X and Y to that of U and V", length(500), SHORTEST, LONGEST,
               unit());
    }
}

void Asking::axis(const Preset &preset) {
    const std::string letter(1, preset.letter), key = to_lower(letter);
    number(key + ".min", letter + ": lower limit", length(preset.min), -LONGEST, LONGEST, unit());
    number(key + ".max", letter + ": upper limit", length(preset.max), -LONGEST, LONGEST, unit());
    number(key + ".speed", letter + ": maximum speed", length(preset.speed), SHORTEST, LONGEST, unit("/s"));
    number(key + ".acceleration", letter + ": acceleration", length(preset.acceleration), SHORTEST, LONGEST,
           unit("/s2"));
    if (!isChosen("switches", "none")) {
        const bool at_max = preset.letter == 'Z' || kind_.name == "lathe";
        choice(key + ".home", letter + ": end with the home switch",
               at_max ? std::vector<std::string>{"max", "min"} : std::vector<std::string>{"min", "max"});
        number(key + ".home_speed", letter + ": speed towards the home switch", length(10), SHORTEST, LONGEST,
               unit("/s"));
    }
}

void Asking::stepper() {
    constexpr int MOST_NS = 1000000;
    whole("step.length", "Step pulse width", 5000, 100, MOST_NS, "ns");
    whole("step.space", "Step pulse spacing", 5000, 100, MOST_NS, "ns");
    whole("step.dir_setup", "Direction setup time", 20000, 0, MOST_NS, "ns");
    whole("step.dir_hold", "Direction hold time", 20000, 0, MOST_NS, "ns");
    whole("latency", "Latency of this computer (latency-test)", 15000, 1000, MOST_NS, "ns");
    int next_output = 2, next_input = 11;
    for (const std::string &name : motors_of(kind_.name)) {
        motor(name, next_output, next_input);
    }
    whole("pin.enable", "Drive enable pin, 0: none", 17, 0, 17);
    if (!isChosen("spindle", "none")) {
        whole("pin.spindle_on", "Spindle or hot wire pin, 0: none", 14, 0, 17);
    }
    if (isChosen("spindle", "speed")) {
        whole("pin.spindle_pwm", "Spindle speed pin (PWM)", 16, 1, 17);
        number("spindle.pwm_hz", "PWM frequency", 100, 1, 5000, "Hz");
    }
    whole("pin.flood", "Coolant pin, 0: none", kind_.name == "foam" ? 0 : 1, 0, 17);
    whole("pin.estop", "Emergency stop pin, high while the button is released, 0: none", 10, 0, 15);
    if (!isChosen("switches", "none")) {
        choice("switch.contacts", "Switch contacts", {"open", "closed"});
    }
}

void Asking::motor(const std::string &name, int &next_output, int &next_input) {
    const std::string motor = "Motor " + to_upper(name) + ": ";
    number(name + ".steps_per_turn", motor + "full steps per revolution", 200, 1, 100000);
    number(name + ".microsteps", motor + "microsteps per full step", 4, 1, 1024);
    number(name + ".way_per_turn", motor + "travel per revolution (negative reverses)",
           length(kind_.way_per_turn), -LONGEST, LONGEST, unit());
    whole(name + ".step_pin", motor + "step pin", next_output, 1, 17);
    whole(name + ".dir_pin", motor + "direction pin", next_output + 1, 1, 17);
    next_output += 2;
    if (!isChosen("switches", "none")) {
        constexpr int BEHIND_13 = 15;
        whole(name + ".home_pin", motor + "home switch pin", next_input, 10, 15);
        next_input = next_input == 13 ? BEHIND_13 : next_input + 1;
    }
}

}  // namespace

std::string_view axes_of(std::string_view kind) {
    const auto *const found = std::ranges::find(ALL, kind, &Kind::name);
    return found == ALL.end() ? "" : found->axes;
}

std::vector<std::string> motors_of(std::string_view kind) {
    std::vector<std::string> motors;
    for (const char letter : axes_of(kind)) {
        const std::string name = to_lower(std::string(1, letter));
        motors.push_back(name);
        if (kind == "gantry" && letter == 'Y') {
            motors.push_back(name + "2");
        }
    }
    return motors;
}

std::vector<Question> questions(const Answers &given) {
    return Asking(given, kind_of(given)).all();
}

std::string answer_of(const std::vector<Question> &asked, const Answers &given, std::string_view key) {
    const auto found = given.find(key);
    if (found != given.end()) {
        return std::string(trim(found->second));
    }
    const auto question = std::ranges::find(asked, key, &Question::key);
    return question == asked.end() ? "" : question->preset;
}

}  // namespace mw::setup
