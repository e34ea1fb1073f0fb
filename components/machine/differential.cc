// SPDX-License-Identifier: GPL-2.0-or-later
// differential: kinematics of a differential gear with two motors. The motors turn together for roll and
// against each other for pitch: motor0 = roll + pitch, motor1 = roll - pitch, and back for the feedback. Pins
// (float) [degrees]: roll-cmd, pitch-cmd, motor0-fb, motor1-fb; outputs motor0-cmd, motor1-cmd, roll-fb,
// pitch-fb.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Differential {
    In<double> roll_cmd, pitch_cmd, motor0_fb, motor1_fb;
    Out<double> roll_fb, pitch_fb, motor0_cmd, motor1_cmd;

    void declare(Declare &d) noexcept {
        d.pin(roll_cmd, "roll-cmd");
        d.pin(pitch_cmd, "pitch-cmd");
        d.pin(roll_fb, "roll-fb");
        d.pin(pitch_fb, "pitch-fb");
        d.pin(motor0_cmd, "motor0-cmd");
        d.pin(motor1_cmd, "motor1-cmd");
        d.pin(motor0_fb, "motor0-fb");
        d.pin(motor1_fb, "motor1-fb");
        d.function<&Differential::update>(this);
    }

    void update() noexcept {
        const double roll = roll_cmd;
        const double pitch = pitch_cmd;
        const double first = motor0_fb;
        const double second = motor1_fb;
        set_finite(motor0_cmd, roll + pitch);
        set_finite(motor1_cmd, roll - pitch);
        set_finite(roll_fb, (first + second) / 2.0);
        set_finite(pitch_fb, (first - second) / 2.0);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Differential, "differential", mw::sdk::MANY);
