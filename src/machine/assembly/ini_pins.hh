// SPDX-License-Identifier: GPL-2.0-or-later
// HAL pins that change settings of the INI file at run time: component "inihal".
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/result.hh"
#include "hal/core/user_pin.hh"
#include "machine/task/task.hh"
#include "motion/interface/settings.hh"

namespace mw::machine {

/// ini.N.* of joints, ini.L.* of axes, ini.traj-*, from one table in ini_pins.cc. Their initial values are
/// those of the INI file, or 0 if the key is not set. Not realtime; one thread.
class IniPins {
  public:
    /// [TRAJ]DEFAULT_LINEAR_VELOCITY and DEFAULT_LINEAR_ACCELERATION, which have no effect.
    struct Defaults {
        double velocity = 0, acceleration = 0;
    };
    /// Creates the component and its pins.
    Result<> create(hal::Instance &hal, const std::vector<motion::SetParameter> &parameters, int num_joints,
                    const Defaults &defaults);
    void destroy();
    /// Sends changes since the last call to task. Speeds and accelerations wait until nothing moves in a jog
    /// mode; nothing changes during homing.
    void step(task::Task &task);

    /// Effect of a pin.
    struct Use {
        motion::Parameter parameter = motion::Parameter::COUNT;  ///< COUNT: no effect
        bool isRate = false;                                     ///< changes only at standstill
        bool positive = false;
    };

  private:
    struct Pin {
        std::string name;
        std::variant<hal::UserPin<double>, hal::UserPin<std::int32_t>, hal::UserPin<bool>> pin;
        Use use;
        int index = 0;
        double last = 0;
        bool waiting = false, wait_reported = false;

        double value() const noexcept;
        void set(double to);
    };
    template <class T>
    void make_named(hal::UserPin<T> &pin, const std::string &name, hal::Instance &hal, Result<> &status);
    void make_pins(int num_joints, const Defaults &defaults, hal::Instance &hal, Result<> &status);
    bool isTaken(const Pin &pin, double value, task::Task &task) const;
    void step(Pin &pin, task::Task &task);

    hal::Instance *hal_ = nullptr;
    int comp_id_ = 0;
    std::vector<Pin> pins_;
    hal::UserPin<std::int32_t> planner_type_;
    hal::UserPin<double> corner_scale_;
    std::int32_t last_type_ = 0;
    double last_scale_ = 1;
};

}  // namespace mw::machine
