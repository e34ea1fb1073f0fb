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
            if (plan_.hasBoard()) {
                wiring();
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
    double travel_per_turn(const std::string &name);
    Motor motor(const std::string &name);
    Terminal terminal(const std::string &key);
    void wiring();
    void check_rates();
    void check_terminals();
    void check_channels();

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
            fault(key,
                  "this machine type has no such key" + (near.empty() ? "" : "; did you mean " + near + "?"));
        }
    }
}

void Reader::check(const Question &question) {
    const std::string answer = text(question.key);
    if (question.form == Form::CHOICE) {
        if (std::ranges::find(question.choices, answer) == question.choices.end()) {
            fault(question.key,
                  fmt::format("'{}' is not one of {}", printable(answer), fmt::join(question.choices, ", ")));
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
        fault(question.key, fmt::format("'{}' is not a {}", printable(answer),
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
    plan_.is_servo = text("drives") == "servo";
    const std::string board = text("board");
    plan_.board = board == "parport" ? Board::PARPORT
                  : board == "7i76e" ? Board::MESA_7I76E
                  : board == "7i97"  ? Board::MESA_7I97
                                     : Board::NONE;
    plan_.is_tool_changed_by_hand = text("tool_change") == "by_hand";
    const std::string switches = text("switches"), spindle = text("spindle");
    plan_.switches = switches == "none"   ? Switches::NONE
                     : switches == "home" ? Switches::HOME
                                          : Switches::HOME_AND_LIMITS;
    plan_.spindle = spindle.empty() || spindle == "none" ? Spindle::NONE
                    : spindle == "on_off"                ? Spindle::ON_OFF
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
        // The first program does not fit into a shorter travel.
        const double shortest = plan_.small(axis, 10);
        if (axis.max - axis.min < shortest) {
            fault(key + ".max", fmt::format("the travel is {}, but must be at least {}",
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

double Reader::travel_per_turn(const std::string &name) {
    const std::string transmission = text(name + ".transmission");
    if (transmission == "travel") {
        const double travel = number(name + ".way_per_turn");
        if (travel == 0) {
            fault(name + ".way_per_turn", "a travel of 0 is not possible");
        }
        return travel;
    }
    constexpr double DEGREES = 360;
    const double output = transmission == "screw"  ? number(name + ".pitch")
                          : transmission == "belt" ? number(name + ".teeth") * number(name + ".belt_pitch")
                          : transmission == "rack" ? number(name + ".teeth") * number(name + ".module") * M_PI
                                                   : DEGREES;
    return output / number(name + ".gear") * (text(name + ".reverse") == "yes" ? -1 : 1);
}

Motor Reader::motor(const std::string &name) {
    Motor motor{.name = name};
    if (!plan_.hasBoard()) {
        return motor;
    }
    motor.travel_per_turn = travel_per_turn(name);
    if (motor.travel_per_turn == 0) {
        return motor;
    }
    const double correction = number(name + ".correction");
    motor.backlash = number(name + ".backlash");
    if (plan_.is_stepper) {
        motor.steps_per_unit = number(name + ".steps_per_turn") * number(name + ".microsteps") /
                               motor.travel_per_turn * correction;
    } else {
        const double reversed = text(name + ".reverse_encoder") == "yes" ? -1 : 1;
        const double output = text(name + ".reverse_output") == "yes" ? -1 : 1;
        motor.servo = {.counts_per_unit =
                           reversed * number(name + ".counts_per_turn") / motor.travel_per_turn * correction,
                       .full_speed =
                           output * number(name + ".full_speed") * motor.travel_per_turn / correction,
                       .p = number(name + ".p"),
                       .i = number(name + ".i"),
                       .d = number(name + ".d"),
                       .ff1 = number(name + ".ff1"),
                       .ff2 = number(name + ".ff2")};
    }
    motor.channel = whole(name + ".channel");
    motor.step_pin = whole(name + ".step_pin");
    motor.dir_pin = whole(name + ".dir_pin");
    if (plan_.switches != Switches::NONE) {
        motor.home_pin = terminal(name + ".home_pin");
        const std::string own = text(name + ".home_contact");
        motor.home_contact_closed = (own == "as_all" ? text("switch.contacts") : own) == "closed";
    }
    return motor;
}

Terminal Reader::terminal(const std::string &key) {
    const std::string answer = text(key);
    const int none = plan_.board == Board::PARPORT ? 0 : -1;
    return answer.empty() || whole(key) == none ? Terminal{} : Terminal{whole(key)};
}

void Reader::wiring() {
    Wiring &w = plan_.wiring;
    w.address = text("board.address");
    w.isSimulated = text("board.simulated") == "yes";
    w.step_length_ns = whole("step.length");
    w.step_space_ns = whole("step.space");
    w.dir_setup_ns = whole("step.dir_setup");
    w.dir_hold_ns = whole("step.dir_hold");
    if (plan_.board == Board::PARPORT) {
        w.base_period_ns = base_period(whole("latency"), w.step_length_ns, w.step_space_ns);
    }
    w.enable_pin = terminal("pin.enable");
    w.flood_pin = terminal("pin.flood");
    w.mist_pin = terminal("pin.mist");
    w.estop_pin = terminal("pin.estop");
    w.probe_pin = terminal("pin.probe");
    w.torch_pin = terminal("pin.torch");
    w.arc_ok_pin = terminal("pin.arc_ok");
    w.probe_contact_closed = text("probe.contacts") == "closed";
    w.hasWheel = text("pendant") == "wheel";
    const std::string drive = text("spindle.drive");
    w.spindle = {.command = drive == "analog"   ? SpeedCommand::ANALOG
                            : drive == "step"   ? SpeedCommand::STEP
                            : drive == "modbus" ? SpeedCommand::MODBUS
                                                : SpeedCommand::PWM,
                 .full_output = number("spindle.full_output"),
                 .pwm_hz = number("spindle.pwm_hz"),
                 .steps_per_turn = number("spindle.steps_per_turn"),
                 .on_pin = terminal("pin.spindle_on"),
                 .speed_pin = terminal("pin.spindle_pwm"),
                 .vfd = text("spindle.vfd"),
                 .device = text("spindle.device")};
    if (plan_.hasBaseThread()) {
        check_rates();
    }
    check_terminals();
    check_channels();
}

/// A step pulse is high for at least one period and low for at least one.
void Reader::check_rates() {
    constexpr double NS_PER_S = 1e9;
    // Factor of the axis speed at which the step generator can catch up with following errors.
    constexpr double MARGIN = 1.05;
    const double highest = NS_PER_S / (2.0 * plan_.wiring.base_period_ns);
    for (const Axis &axis : plan_.axes) {
        for (const Motor &motor : axis.motors) {
            const double rate = std::abs(motor.steps_per_unit) * axis.speed * MARGIN;
            if (rate > highest) {
                fault(to_lower(std::string(1, axis.letter)) + ".speed",
                      fmt::format(
                          "motor {} would need {:.0f} steps in a second, and {:.0f} can be made with a base "
                          "period of {} ns: a lower speed, fewer microsteps, or a board that makes steps",
                          to_upper(motor.name), rate, highest, plan_.wiring.base_period_ns));
            }
        }
    }
    const SpindleWiring &spindle = plan_.wiring.spindle;
    if (spindle.pwm_hz * 20 > NS_PER_S / plan_.wiring.base_period_ns) {
        fault("spindle.pwm_hz", "leaves fewer than 20 steps of speed: a lower frequency");
    }
    constexpr double S_PER_MIN = 60;
    const double rate = spindle.steps_per_turn * plan_.spindle_max / S_PER_MIN;
    if (rate > highest) {
        fault("spindle.max", fmt::format("needs {:.0f} steps in a second, and {:.0f} can be made with a base "
                                         "period of {} ns: a lower speed or fewer steps of a revolution",
                                         rate, highest, plan_.wiring.base_period_ns));
    }
}

/// Each terminal has one use, in the direction of the board.
void Reader::check_terminals() {
    constexpr std::array OUTPUTS{1, 2, 3, 4, 5, 6, 7, 8, 9, 14, 16, 17};
    constexpr std::array INPUTS{10, 11, 12, 13, 15};
    const bool port = plan_.board == Board::PARPORT;
    struct Use {
        int number;
        bool is_input;
        std::string key;
    };
    std::vector<Use> used;
    for (const Question &question : asked_) {
        const std::string &key = question.key;
        const bool is_terminal = key.ends_with("_pin") || key.starts_with("pin.");
        const Terminal terminal = is_terminal ? this->terminal(key) : Terminal{};
        if (!terminal.has_value()) {
            continue;
        }
        const int pin = *terminal;
        const bool is_input =
            key.ends_with(".home_pin") || key == "pin.estop" || key == "pin.probe" || key == "pin.arc_ok";
        const bool present = is_input ? std::ranges::find(INPUTS, pin) != INPUTS.end()
                                      : std::ranges::find(OUTPUTS, pin) != OUTPUTS.end();
        if (port && !present) {
            fault(key, fmt::format("pin {} is no {}", pin,
                                   is_input ? "input: 10, 11, 12, 13 and 15 are"
                                            : "output: 1 to 9, 14, 16 and 17 are"));
        }
        const auto other = std::ranges::find_if(
            used, [&](const Use &use) { return use.number == pin && (port || use.is_input == is_input); });
        if (other != used.end()) {
            fault(key, fmt::format("{} {} is used by {} already",
                                   port       ? "pin"
                                   : is_input ? "input"
                                              : "output",
                                   pin, other->key));
        }
        used.push_back({pin, is_input, key});
    }
}

/// Each connector has one motor.
void Reader::check_channels() {
    std::vector<std::pair<int, std::string>> used;
    for (const Question &question : asked_) {
        if (!question.key.ends_with(".channel")) {
            continue;
        }
        const int channel = whole(question.key);
        const auto other = std::ranges::find(used, channel, &std::pair<int, std::string>::first);
        if (other != used.end()) {
            fault(question.key, fmt::format("connector {} is used by {} already", channel, other->second));
        }
        used.emplace_back(channel, question.key);
    }
    // The last step generator of a 7I76E is for the spindle.
    constexpr int SPINDLE_CHANNEL = 4;
    if (plan_.board == Board::MESA_7I76E && text("spindle.drive") == "step" &&
        std::ranges::find(used, SPINDLE_CHANNEL, &std::pair<int, std::string>::first) != used.end()) {
        fault("spindle.drive", "step: connector 4 is that of a motor");
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
        speed = std::max(speed, axis.isRotary() ? 0 : axis.speed);
    }
    return speed;
}

Planned plan_of(const Answers &given) {
    return Reader(given).read();
}

}  // namespace mw::setup
