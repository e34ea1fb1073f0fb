// SPDX-License-Identifier: GPL-2.0-or-later
// plant_axis: a motor with its load under a drive that follows positions.
#include "components/plants/axis.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantAxis {
    static constexpr plants::AxisSettings START{};
    In<double> command, zero, peak_acceleration, coulomb_friction, viscous_friction, backlash, position_gain,
        velocity_gain;
    In<bool> powered;
    Out<double> motor, load, velocity;
    plants::Axis axis;
    bool wasPowered = false;

    void declare(Declare &d) noexcept {
        d.pin(command, "command");
        d.pin(zero, "zero");
        d.pin(powered, "powered");
        d.pin(peak_acceleration, "peak-acceleration", START.peak_acceleration);
        d.pin(coulomb_friction, "coulomb-friction");
        d.pin(viscous_friction, "viscous-friction");
        d.pin(backlash, "backlash");
        d.pin(position_gain, "position-gain", START.position_gain);
        d.pin(velocity_gain, "velocity-gain", START.velocity_gain);
        d.pin(motor, "motor");
        d.pin(load, "load");
        d.pin(velocity, "velocity");
        d.function<&PlantAxis::update>(this);
    }
    void update(long period_ns) noexcept {
        axis.set(
            {peak_acceleration, coulomb_friction, viscous_friction, backlash, position_gain, velocity_gain});
        if (powered && !wasPowered) {
            axis.hold_here();
        }
        wasPowered = powered;
        axis.run(command + zero, powered, static_cast<double>(period_ns) * 1e-9);
        motor = axis.motor();
        load = axis.load();
        velocity = axis.velocity();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantAxis, "plant_axis", mw::sdk::MANY);
