// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/assembly/ini_pins.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "base/geometry/pose.hh"

namespace mw::machine {

namespace {

using motion::Parameter;

enum class PinType : std::uint8_t { NUMBER, WHOLE, BIT };

/// One row of the table. `preset` is the initial value of a pin without effect.
struct IniPin {
    std::string_view name;
    IniPins::Use use;
    PinType type = PinType::NUMBER;
    double preset = 0;
};

constexpr IniPins::Use AT_ONCE(Parameter parameter) {
    return {parameter, false, false};
}
constexpr IniPins::Use RATE(Parameter parameter) {
    return {parameter, true, true};
}
constexpr IniPins::Use NOTHING{};

constexpr std::array OF_JOINTS = {
    IniPin{"backlash", AT_ONCE(Parameter::JOINT_BACKLASH)},
    IniPin{"ferror", AT_ONCE(Parameter::JOINT_FERROR)},
    IniPin{"min-ferror", AT_ONCE(Parameter::JOINT_MIN_FERROR)},
    IniPin{"min-limit", AT_ONCE(Parameter::JOINT_MIN_LIMIT)},
    IniPin{"max-limit", AT_ONCE(Parameter::JOINT_MAX_LIMIT)},
    IniPin{"max-velocity", RATE(Parameter::JOINT_MAX_VELOCITY)},
    IniPin{"max-acceleration", RATE(Parameter::JOINT_MAX_ACCELERATION)},
    IniPin{"max-jerk", RATE(Parameter::JOINT_MAX_JERK)},
    IniPin{"home", AT_ONCE(Parameter::JOINT_HOME)},
    IniPin{"home-offset", AT_ONCE(Parameter::JOINT_HOME_OFFSET)},
    IniPin{"home-sequence", AT_ONCE(Parameter::JOINT_HOME_SEQUENCE), PinType::WHOLE},
};
constexpr std::array OF_AXES = {
    IniPin{"min-limit", AT_ONCE(Parameter::AXIS_MIN_LIMIT)},
    IniPin{"max-limit", AT_ONCE(Parameter::AXIS_MAX_LIMIT)},
    IniPin{"max-velocity", RATE(Parameter::AXIS_MAX_VELOCITY)},
    IniPin{"max-acceleration", RATE(Parameter::AXIS_MAX_ACCELERATION)},
    IniPin{"max-jerk", RATE(Parameter::AXIS_MAX_JERK)},
};
constexpr std::array OF_TRAJECTORY = {
    IniPin{"max-velocity", RATE(Parameter::TRAJ_MAX_VELOCITY)},
    IniPin{"max-acceleration", RATE(Parameter::TRAJ_MAX_ACCELERATION)},
    IniPin{"max-jerk", RATE(Parameter::TRAJ_MAX_JERK)},
    IniPin{"default-velocity", NOTHING},
    IniPin{"default-acceleration", NOTHING},
    IniPin{"arc-blend-enable", NOTHING, PinType::BIT, 1},
    IniPin{"arc-blend-fallback-enable", NOTHING, PinType::BIT},
    IniPin{"arc-blend-gap-cycles", NOTHING, PinType::NUMBER, 4},
    IniPin{"arc-blend-optimization-depth", NOTHING, PinType::WHOLE, 50},
    IniPin{"arc-blend-ramp-freq", NOTHING, PinType::NUMBER, 100},
    IniPin{"arc-blend-tangent-kink-ratio", NOTHING, PinType::NUMBER, 0.1},
};

/// The opposite limit of a joint or axis; COUNT: not a limit.
Parameter other_limit(Parameter parameter) {
    switch (parameter) {
    case Parameter::JOINT_MIN_LIMIT: return Parameter::JOINT_MAX_LIMIT;
    case Parameter::JOINT_MAX_LIMIT: return Parameter::JOINT_MIN_LIMIT;
    case Parameter::AXIS_MIN_LIMIT: return Parameter::AXIS_MAX_LIMIT;
    case Parameter::AXIS_MAX_LIMIT: return Parameter::AXIS_MIN_LIMIT;
    default: return Parameter::COUNT;
    }
}

bool isLower(Parameter parameter) {
    return parameter == Parameter::JOINT_MIN_LIMIT || parameter == Parameter::AXIS_MIN_LIMIT;
}

}  // namespace

inline double IniPins::Pin::value() const noexcept {
    if (const auto *number = std::get_if<hal::UserPin<double>>(&pin)) {
        return number->get();
    }
    if (const auto *whole = std::get_if<hal::UserPin<std::int32_t>>(&pin)) {
        return whole->get();
    }
    return std::get<hal::UserPin<bool>>(pin).get() ? 1.0 : 0.0;
}

void IniPins::Pin::set(double to) {
    std::visit([to]<class T>(hal::UserPin<T> &p) { p.set(static_cast<T>(to)); }, pin);
    last = value();
}

/// Also accepts LinuxCNC's name, with underscores.
template <class T>
void IniPins::make_named(hal::UserPin<T> &pin, const std::string &name, hal::Instance &hal,
                         Result<> &status) {
    std::string legacy = name;
    std::ranges::replace(legacy, '-', '_');
    pin.make(hal, comp_id_, legacy, hal::Dir::IN, status);
    if (status.has_value() && legacy != name) {
        status = hal.pins().set_alias(legacy, name);
    }
}

void IniPins::make_pins(int num_joints, const Defaults &defaults, hal::Instance &hal, Result<> &status) {
    const auto make = [&](const std::string &prefix, const IniPin &row, int index) {
        Pin pin;
        pin.name = prefix + std::string(row.name);
        pin.use = row.use;
        pin.index = index;
        switch (row.type) {
        case PinType::NUMBER: pin.pin.emplace<hal::UserPin<double>>(); break;
        case PinType::WHOLE: pin.pin.emplace<hal::UserPin<std::int32_t>>(); break;
        case PinType::BIT: pin.pin.emplace<hal::UserPin<bool>>(); break;
        }
        std::visit([&](auto &p) { make_named(p, pin.name, hal, status); }, pin.pin);
        if (status.has_value()) {
            pin.set(row.name == "default-velocity"       ? defaults.velocity
                    : row.name == "default-acceleration" ? defaults.acceleration
                                                         : row.preset);
            pins_.push_back(std::move(pin));
        }
    };
    for (int j = 0; j < num_joints; ++j) {
        for (const IniPin &row : OF_JOINTS) {
            make(fmt::format("ini.{}.", j), row, j);
        }
    }
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        for (const IniPin &row : OF_AXES) {
            make(fmt::format("ini.{}.", geometry::AXIS_LETTERS_LOWER[i]), row, i);
        }
    }
    for (const IniPin &row : OF_TRAJECTORY) {
        make("ini.traj-", row, 0);
    }
    make_named(planner_type_, "ini.traj-planner-type", hal, status);
    make_named(corner_scale_, "ini.traj-scurve-peak-scale", hal, status);
}

Result<> IniPins::create(hal::Instance &hal, const std::vector<motion::SetParameter> &parameters,
                         int num_joints, const Defaults &defaults) {
    const auto id = hal.components().create("inihal");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    Result<> status;
    make_pins(num_joints, defaults, hal, status);
    if (!status.has_value()) {
        destroy();
        return status;
    }
    for (const motion::SetParameter &p : parameters) {
        const auto parameter = static_cast<Parameter>(p.parameter);
        if (parameter == Parameter::TRAJ_PLANNER_TYPE) {
            last_type_ = static_cast<std::int32_t>(p.value);
        } else if (parameter == Parameter::TRAJ_CORNER_SCALE) {
            last_scale_ = p.value;
        }
        for (Pin &pin : pins_) {
            if (pin.use.parameter == parameter && pin.index == p.index) {
                pin.set(p.value);
            }
        }
    }
    planner_type_ = last_type_;
    corner_scale_ = last_scale_;
    status = hal.components().set_ready(comp_id_);
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

void IniPins::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->components().remove(comp_id_));
        hal_ = nullptr;
        pins_.clear();
    }
}

/// Reports values that were not accepted, with the name of the pin.
bool IniPins::isTaken(const Pin &pin, double value, task::Task &task) const {
    const auto refuse = [&](const std::string &why) {
        task.post(messages::MessageKind::OPERATOR_ERROR, fmt::format("{} is {}: {}", pin.name, value, why));
        return false;
    };
    if (pin.use.parameter == Parameter::COUNT) {
        return refuse("this setting has no effect");
    }
    const motion::ParameterInfo &info = motion::PARAMETERS[static_cast<std::size_t>(pin.use.parameter)];
    if (!std::isfinite(value)) {
        return refuse("a finite number is expected; the old value stays active");
    }
    if (value < info.lowest || value > info.highest || (pin.use.positive && value <= 0)) {
        return refuse("the value is out of range; the old value stays active");
    }
    const Parameter other = other_limit(pin.use.parameter);
    if (other != Parameter::COUNT) {
        const double end = task.motion_settings().get(other, pin.index);
        if (isLower(pin.use.parameter) ? value >= end : value <= end) {
            return refuse(fmt::format("the other limit is {}; the old value stays active", end));
        }
    }
    return true;
}

void IniPins::step(Pin &pin, task::Task &task) {
    const double value = pin.value();
    const bool changed = value != pin.last && !(std::isnan(value) && std::isnan(pin.last));
    if (changed) {
        pin.last = value;
        pin.waiting = isTaken(pin, value, task);
        pin.wait_reported = false;
    }
    if (!pin.waiting) {
        return;
    }
    const motion::Status &motion = task.motion_status();
    const bool at_rest = motion.mode != motion::Mode::COORD && motion.isInPosition;
    if (motion.isHoming || (pin.use.isRate && !at_rest)) {
        if (!pin.wait_reported) {
            task.post(messages::MessageKind::OPERATOR_TEXT,
                      pin.name + " waits until the machine is stopped in manual mode and no joint is homing");
        }
        pin.wait_reported = true;
        return;
    }
    pin.waiting = false;
    const motion::SetParameter setting{static_cast<std::uint16_t>(pin.use.parameter),
                                       static_cast<std::int16_t>(pin.index), pin.last};
    task.change(setting);
}

void IniPins::step(task::Task &task) {
    for (Pin &pin : pins_) {
        if (pin.waiting || pin.value() != pin.last) {
            step(pin, task);
        }
    }
    const std::int32_t type = planner_type_;
    const double scale = corner_scale_;
    if (type != last_type_) {
        last_type_ = type;
        task.planner_mode().wish(type);
    }
    if (scale != last_scale_) {
        last_scale_ = scale;
        task.planner_mode().set_corner_scale(scale);
    }
}

}  // namespace mw::machine
