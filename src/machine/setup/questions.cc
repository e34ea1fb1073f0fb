// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/setup/questions.hh"

#include <algorithm>
#include <array>

#include <fmt/ranges.h>

#include "base/text.hh"
#include "machine/setup/detail/asking.hh"

namespace mw::setup {
namespace detail {
namespace {

constexpr AxisPreset TILT{'A', -110, 110, 20, 150}, TURN{'A', -360, 360, 60, 400},
    TABLE{'C', -360, 360, 60, 400};
constexpr AxisPreset MILL_X{'X', 0, 300, 40, 300}, MILL_Y{'Y', 0, 150, 40, 300},
    MILL_Z{'Z', -120, 0, 25, 300};

constexpr std::array<Kind, std::size(KINDS)> ALL{{
    {"mill", "XYZ", 5, {{MILL_X, MILL_Y, MILL_Z, {}, {}}}},
    {"router",
     "XYZ",
     10,
     {{{'X', 0, 600, 80, 500}, {'Y', 0, 900, 80, 500}, {'Z', -100, 0, 40, 300}, {}, {}}}},
    {"gantry",
     "XYZ",
     10,
     {{{'X', 0, 1000, 100, 500}, {'Y', 0, 1500, 100, 500}, {'Z', -150, 0, 40, 300}, {}, {}}}},
    {"lathe", "XZ", 5, {{{'X', -5, 100, 25, 250}, {'Z', -300, 0, 30, 250}, {}, {}, {}}}},
    {"foam",
     "XYUV",
     5,
     {{{'X', 0, 600, 25, 200}, {'Y', 0, 300, 25, 200}, {'U', 0, 600, 25, 200}, {'V', 0, 300, 25, 200}, {}}}},
    {"plasma",
     "XYZ",
     10,
     {{{'X', 0, 1250, 120, 700}, {'Y', 0, 1250, 120, 700}, {'Z', -100, 0, 50, 500}, {}, {}}}},
    {"mill4", "XYZA", 5, {{MILL_X, MILL_Y, MILL_Z, TURN, {}}}},
    {"mill5", "XYZAC", 5, {{MILL_X, MILL_Y, MILL_Z, TILT, TABLE}}},
}};

bool isRotary(char letter) {
    return letter >= 'A' && letter <= 'C';
}

}  // namespace

const Kind &kind_of(const Answers &given) {
    const auto answer = given.find("kind");
    const std::string_view name = answer == given.end() ? "" : std::string_view(answer->second);
    const auto *const found = std::ranges::find(ALL, name, &Kind::name);
    return found == ALL.end() ? ALL[0] : *found;
}

std::vector<std::string> kind_names() {
    std::vector<std::string> names;
    for (const Kind &kind : ALL) {
        names.emplace_back(kind.name);
    }
    return names;
}

bool Asking::isAsked(std::string_view key) const {
    return std::ranges::find(asked_, key, &Question::key) != asked_.end();
}

void Asking::choice(std::string key, std::string text, std::vector<std::string> choices, std::string reason) {
    std::string preset = choices[0];
    asked_.push_back({std::move(key), std::move(text), Form::CHOICE, std::move(preset), std::move(choices), 0,
                      0, "", std::move(reason)});
}

void Asking::number(std::string key, std::string text, double preset, const char *unit, std::string reason) {
    asked_.push_back({std::move(key),
                      std::move(text),
                      Form::NUMBER,
                      to_text(preset),
                      {},
                      SHORTEST,
                      LONGEST,
                      unit,
                      std::move(reason)});
}

void Asking::within(double low, double high) {
    asked_.back().low = low;
    asked_.back().high = high;
}

void Asking::whole(std::string key, std::string text, int preset, const char *unit, std::string reason) {
    asked_.push_back({std::move(key),
                      std::move(text),
                      Form::WHOLE,
                      std::to_string(preset),
                      {},
                      0,
                      1e6,
                      unit,
                      std::move(reason)});
}

void Asking::text(std::string key, std::string text, std::string preset, std::string reason) {
    asked_.push_back(
        {std::move(key), std::move(text), Form::TEXT, std::move(preset), {}, 0, 0, "", std::move(reason)});
}

std::vector<Question> Asking::all() {
    general();
    board();
    spindle();
    for (std::size_t i = 0; i < kind_.axes.size(); ++i) {
        axis(kind_.presets.at(i));
    }
    if (!isChosen("drives", "simulated")) {
        timing();
        motors();
        terminals();
    }
    return std::move(asked_);
}

void Asking::general() {
    choice("kind", "Machine type", kind_names(), "The type decides the axes and their usual sizes.");
    asked_.back().preset = kind_.name;
    text("name", "Machine name", "My " + std::string(kind_.name), "It is shown on the screen.");
    choice("units", "Length unit", {"mm", "inch"}, "Most drawings and screws are in mm.");
    metric_ = isChosen("units", "mm");
    choice("drives", "Motors", {"simulated", "stepper", "servo"},
           "Simulated motors need no hardware. Servo: drives with a speed command of -10 V to 10 V and "
           "encoders.");
}

void Asking::board() {
    if (!isChosen("drives", "simulated")) {
        const bool needs_board = kind_.axes.size() > 4;
        choice("board", "Board",
               isChosen("drives", "servo") ? std::vector<std::string>{"7i97"}
               : needs_board               ? std::vector<std::string>{"7i76e"}
                                           : std::vector<std::string>{"parport", "7i76e"},
               needs_board ? "A parallel port has too few pins for five motors with switches."
                           : "The first of these that can drive such motors.");
        choice("board.simulated", "Simulate the board", {"yes", "no"},
               "Try the machine at the desk first; change to no when the board is connected.");
        if (isChosen("board.simulated", "no")) {
            text("board.address", "Address of the board", isPort() ? "0x378" : "192.168.1.121",
                 isPort() ? "The first parallel port of most computers."
                          : "The address that these boards have by default.");
        }
    }
    choice("switches", "Switches", {"none", "home", "home_and_limits"},
           "Without switches the machine is at zero where it is when homed.");
}

void Asking::spindle() {
    const bool is_foam = isFoam(), hasHardware = !isChosen("drives", "simulated");
    if (!isPlasma()) {
        choice("spindle", is_foam ? "Hot wire" : "Spindle", {"speed", "on_off", "none"},
               "Most machines set the speed in the program.");
    }
    if (isAsked("spindle") && isChosen("spindle", "speed")) {
        number("spindle.max", is_foam ? "S value for full heat" : "Maximum spindle speed",
               is_foam ? 100 : 12000, is_foam ? "" : "rev/min",
               "The speed at full output; see the data sheet of the spindle.");
        within(1, 1e6);
        if (hasHardware) {
            std::vector<std::string> how{isPort() ? "pwm" : "analog"};
            if (isPort() || isChosen("board", "7i76e")) {
                how.emplace_back("step");
            }
            how.emplace_back("modbus");
            choice("spindle.drive", "Speed command", std::move(how), "The output that the board has.");
        }
    }
    choice("tool_change", "Tool change",
           is_foam || isPlasma() ? std::vector<std::string>{"none", "by_hand"}
                                 : std::vector<std::string>{"by_hand", "none"},
           "By hand: the machine asks, then waits.");
    if (is_foam) {
        number("foam.width", "Distance from the XY plane to the UV plane", length(500), unit(),
               "The distance between the two ends of the wire.");
    }
}

void Asking::axis(const AxisPreset &preset) {
    const std::string letter(1, preset.letter), key = to_lower(letter);
    const bool rotary = isRotary(preset.letter);
    const auto in_units = [&](double value) { return rotary ? value : length(value); };
    const std::string length_unit = rotary ? "deg" : unit();
    const std::string speed_unit = length_unit + "/s", acceleration_unit = length_unit + "/s2";
    number(key + ".min", letter + ": lower limit", in_units(preset.min), length_unit.c_str(),
           "A usual size; measure yours between the ends of travel.");
    within(-LONGEST, LONGEST);
    number(key + ".max", letter + ": upper limit", in_units(preset.max), length_unit.c_str(),
           "A usual size; measure yours between the ends of travel.");
    within(-LONGEST, LONGEST);
    number(key + ".speed", letter + ": maximum speed", in_units(preset.speed), speed_unit.c_str(),
           "Moderate; `millwright commission tune` finds what the motor can do.");
    number(key + ".acceleration", letter + ": acceleration", in_units(preset.acceleration),
           acceleration_unit.c_str(), "Moderate; `millwright commission tune` finds what the motor can do.");
    if (!isChosen("switches", "none")) {
        homing(preset);
    }
}

void Asking::homing(const AxisPreset &preset) {
    const std::string letter(1, preset.letter), key = to_lower(letter);
    const bool at_max = preset.letter == 'Z' || kind_.name == "lathe";
    choice(key + ".home", letter + ": end with the home switch",
           at_max ? std::vector<std::string>{"max", "min"} : std::vector<std::string>{"min", "max"},
           at_max ? "The tool moves away from the work." : "The usual end.");
    const bool rotary = isRotary(preset.letter);
    const std::string speed_unit = std::string(rotary ? "deg" : unit()) + "/s";
    number(key + ".home_speed", letter + ": speed towards the home switch", rotary ? 10 : length(10),
           speed_unit.c_str(), "Slow enough to stop behind the switch and before the end.");
}

}  // namespace detail

std::string_view axes_of(std::string_view kind) {
    const auto *const found = std::ranges::find(detail::ALL, kind, &detail::Kind::name);
    return found == detail::ALL.end() ? "" : found->axes;
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
    return detail::Asking(given, detail::kind_of(given)).all();
}

std::string range_of(const Question &question) {
    if (question.form == Form::NUMBER || question.form == Form::WHOLE) {
        return fmt::format(": {:.7g} to {:.7g}{}{}", question.low, question.high,
                           question.unit.empty() ? "" : " ", question.unit);
    }
    return question.choices.empty() ? "" : fmt::format(": {}", fmt::join(question.choices, ", "));
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
