// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/setup/plan.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::setup {
namespace {

constexpr std::size_t LONGEST_NAME = 60;

/// Whole microseconds, including the run time of the thread.
int base_period(int latency_ns, int step_length_ns, int step_space_ns) {
    constexpr int WORK_NS = 10000, SHORTEST_NS = 20000, GRAIN_NS = 1000;
    const int wanted = latency_ns + std::max(step_length_ns, step_space_ns) + WORK_NS;
    return std::max(SHORTEST_NS, (wanted + GRAIN_NS - 1) / GRAIN_NS * GRAIN_NS);
}

class Reader {
  public:
    explicit Reader(const Answers &given) : given_(given), asked_(questions(given)) {}

    Planned read() {
        check_keys();
        for (const Question &question : asked_) {
            check(question);
        }
        if (faults_.empty()) {
            general();
            axes();
            if (plan_.is_stepper) {
                stepping();
            }
        }
        return {std::move(plan_), std::move(faults_)};
    }

  private:
    std::string text(const std::string &key) const { return answer_of(asked_, given_, key); }
    double number(const std::string &key) const { return parse_double(text(key)).value_or(0); }
    int whole(const std::string &key) const { return static_cast<int>(number(key)); }
    void fault(const std::string &key, std::string what) { faults_.push_back({key, std::move(what)}); }

    void check_keys();
    void check(const Question &question);
    void general();
    void axes();
    Motor motor(const std::string &name);
    void stepping();
    void check_rates();
    void check_pins();

    const Answers &given_;
    std::vector<Question> asked_;
    Plan plan_;
    std::vector<Fault> faults_;
};

void Reader::check_keys() {
    std::vector<std::string> known;
    for (const Question &question : asked_) {
        known.push_back(question.key);
    }
    for (const auto &[key, value] : given_) {
        if (std::ranges::find(known, key) == known.end()) {
            const std::string near = nearest_name(key, known);
            fault(key, "this is not asked of such a machine" +
                           (near.empty() ? "" : "; did you mean " + near + "?"));
        }
    }
}

void Reader::check(const Question &question) {
    const std::string answer = text(question.key);
    if (question.form == Form::CHOICE) {
        if (std::ranges::find(question.choices, answer) == question.choices.end()) {
            fault(question.key,
                  fmt::format("'{}' is none of {}", printable(answer), fmt::join(question.choices, ", ")));
        }
        return;
    }
    if (question.form == Form::TEXT) {
        const bool plain =
            std::ranges::all_of(answer, [](unsigned char c) { return c >= 0x20 && c != 0x7f; });
        if (answer.empty() || answer.size() > LONGEST_NAME || !plain ||
            answer.find_first_of("[]#;=\\\"") != std::string::npos) {
            fault(question.key, fmt::format("a name has 1 to {} characters without []#;=\\\"", LONGEST_NAME));
        }
        return;
    }
    const auto value = parse_double(answer);
    const bool round = value.has_value() && std::floor(*value) == *value;
    if (!value.has_value() || (question.form == Form::WHOLE && !round)) {
        fault(question.key, fmt::format("'{}' is no {}", printable(answer),
                                        question.form == Form::WHOLE ? "whole number" : "number"));
    } else if (*value < question.low || *value > question.high) {
        fault(question.key,
              fmt::format("{} is out of range: {:.7g} to {:.7g}", answer, question.low, question.high));
    }
}

void Reader::general() {
    plan_.kind = text("kind");
    plan_.name = text("name");
    plan_.metric = text("units") == "mm";
    plan_.is_stepper = text("drives") == "stepper";
    plan_.is_tool_changed_by_hand = text("tool_change") == "by_hand";
    const std::string switches = text("switches"), spindle = text("spindle");
    plan_.switches = switches == "none"   ? Switches::NONE
                     : switches == "home" ? Switches::HOME
                                          : Switches::HOME_AND_LIMITS;
    plan_.spindle = spindle == "none"     ? Spindle::NONE
                    : spindle == "on_off" ? Spindle::ON_OFF
                                          : Spindle::SPEED;
    plan_.spindle_max = number("spindle.max");
    plan_.foam_width = number("foam.width");
}

void Reader::axes() {
    const auto motors = motors_of(plan_.kind);
    for (const char letter : axes_of(plan_.kind)) {
        const std::string key = to_lower(std::string(1, letter));
        Axis axis{.letter = letter,
                  .min = number(key + ".min"),
                  .max = number(key + ".max"),
                  .speed = number(key + ".speed"),
                  .acceleration = number(key + ".acceleration"),
                  .home_at_max = text(key + ".home") == "max",
                  .home_speed = number(key + ".home_speed"),
                  .motors = {}};
        // The first program does not fit into shorter travels.
        const double shortest = plan_.millimetres(10);
        if (axis.max - axis.min < shortest) {
            fault(key + ".max", fmt::format("the travel is {}, and must be {} at least",
                                            to_text(axis.max - axis.min), to_text(shortest)));
        }
        if (plan_.switches != Switches::NONE && axis.home_speed > axis.speed) {
            fault(key + ".home_speed", "exceeds the maximum speed of the axis");
        }
        for (const std::string &name : motors) {
            if (name.starts_with(key)) {
                axis.motors.push_back(motor(name));
            }
        }
        plan_.axes.push_back(std::move(axis));
    }
}

Motor Reader::motor(const std::string &name) {
    Motor motor{.name = name};
    if (plan_.is_stepper) {
        const double way = number(name + ".way_per_turn");
        if (way == 0) {
            fault(name + ".way_per_turn", "0 moves nothing");
            return motor;
        }
        motor.steps_per_unit = number(name + ".steps_per_turn") * number(name + ".microsteps") / way;
        motor.step_pin = whole(name + ".step_pin");
        motor.dir_pin = whole(name + ".dir_pin");
        motor.home_pin = whole(name + ".home_pin");
    }
    return motor;
}

void Reader::stepping() {
    Stepping &s = plan_.stepping;
    s.step_length_ns = whole("step.length");
    s.step_space_ns = whole("step.space");
    s.dir_setup_ns = whole("step.dir_setup");
    s.dir_hold_ns = whole("step.dir_hold");
    s.base_period_ns = base_period(whole("latency"), s.step_length_ns, s.step_space_ns);
    s.enable_pin = whole("pin.enable");
    s.spindle_on_pin = whole("pin.spindle_on");
    s.spindle_pwm_pin = whole("pin.spindle_pwm");
    s.flood_pin = whole("pin.flood");
    s.estop_pin = whole("pin.estop");
    s.pwm_hz = number("spindle.pwm_hz");
    s.contacts_closed = text("switch.contacts") == "closed";
    check_rates();
    check_pins();
}

/// A step is high for at least one period and low for one.
void Reader::check_rates() {
    constexpr double NS_PER_S = 1e9;
    // The generator must catch up with following errors at this factor of the axis speed.
    constexpr double MARGIN = 1.05;
    const double highest = NS_PER_S / (2.0 * plan_.stepping.base_period_ns);
    for (const Axis &axis : plan_.axes) {
        for (const Motor &motor : axis.motors) {
            const double rate = std::abs(motor.steps_per_unit) * axis.speed * MARGIN;
            if (rate > highest) {
                fault(to_lower(std::string(1, axis.letter)) + ".speed",
                      fmt::format(
                          "motor {} would need {:.0f} steps in a second, and {:.0f} can be made with a base "
                          "period of {} ns: a lower speed, fewer microsteps, or a board that makes steps",
                          to_upper(motor.name), rate, highest, plan_.stepping.base_period_ns));
            }
        }
    }
    if (plan_.spindle == Spindle::SPEED &&
        plan_.stepping.pwm_hz * 20 > NS_PER_S / plan_.stepping.base_period_ns) {
        fault("spindle.pwm_hz", "leaves fewer than 20 steps of speed: a lower frequency");
    }
}

/// Each pin has one use, in the direction of the port.
void Reader::check_pins() {
    constexpr std::array OUTPUTS{1, 2, 3, 4, 5, 6, 7, 8, 9, 14, 16, 17};
    constexpr std::array INPUTS{10, 11, 12, 13, 15};
    constexpr int UNUSED = 0;
    std::vector<std::pair<int, std::string>> used;
    for (const Question &question : asked_) {
        const std::string &key = question.key;
        const bool is_pin = key.ends_with("_pin") || key.starts_with("pin.");
        const int pin = is_pin ? whole(key) : UNUSED;
        if (pin == UNUSED) {
            continue;
        }
        const bool is_input = key.ends_with(".home_pin") || key == "pin.estop";
        const bool present = is_input ? std::ranges::find(INPUTS, pin) != INPUTS.end()
                                      : std::ranges::find(OUTPUTS, pin) != OUTPUTS.end();
        if (!present) {
            fault(key, fmt::format("pin {} is no {}", pin,
                                   is_input ? "input: 10, 11, 12, 13 and 15 are"
                                            : "output: 1 to 9, 14, 16 and 17 are"));
        }
        const auto other = std::ranges::find(used, pin, &std::pair<int, std::string>::first);
        if (other != used.end()) {
            fault(key, fmt::format("pin {} is used by {} already", pin, other->second));
        }
        used.emplace_back(pin, key);
    }
}

}  // namespace

int Plan::joints() const {
    int joints = 0;
    for (const Axis &axis : axes) {
        joints += static_cast<int>(axis.motors.size());
    }
    return joints;
}

double Plan::fastest() const {
    double speed = 0;
    for (const Axis &axis : axes) {
        speed = std::max(speed, axis.speed);
    }
    return speed;
}

Planned plan_of(const Answers &given) {
    return Reader(given).read();
}

}  // namespace mw::setup
