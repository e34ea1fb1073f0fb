// SPDX-License-Identifier: GPL-2.0-or-later
// plant_stepper: a stepper motor at the pins of a port, with its table, backlash, end stops and a
// home switch.
// It counts the rising edges of `step`, in the direction of `dir`, while `powered` (bit, true at start).
// `table` is the position of the table in machine units; `units-per-step` is negative for a reversed motor.
// `backlash`, `peak-acceleration` (torque at standstill divided by inertia), `fastest` (the speed at which no
// torque is
// left), `microsteps` (steps for a full step of the motor), `lower-end` and `upper-end`
// (end stops) describe the machine; `start` is the initial table position. `switch` (bit) is the level of the
// home switch, which is actuated above `switch-at` (below it while `switch-below`); `switch-inverted`:
// the contact opens. `press` actuates it by hand. `slipped` and `hit` remain true after steps were lost or an
// end stop was hit.
#include "components/plants/stepper_axis.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantStepper {
    static constexpr plants::StepperSettings START{};
    In<bool> step, dir, powered, switch_below, switch_inverted, press;
    In<double> units_per_step, backlash, peak_acceleration, fastest, lower_end, upper_end, start, switch_at,
        microsteps;
    Out<bool> contact, slipped, hit;
    Out<double> table;
    plants::StepperAxis axis;
    bool was_high = false, isPlaced = false;

    void declare(Declare &d) noexcept {
        d.pin(step, "step");
        d.pin(dir, "dir");
        d.pin(powered, "powered", true);
        d.pin(units_per_step, "units-per-step", START.units_per_step);
        d.pin(backlash, "backlash");
        d.pin(peak_acceleration, "peak-acceleration", START.peak_acceleration);
        d.pin(fastest, "fastest", START.fastest);
        d.pin(lower_end, "lower-end", START.lower_end);
        d.pin(upper_end, "upper-end", START.upper_end);
        d.pin(microsteps, "microsteps", START.microsteps);
        d.pin(start, "start");
        d.pin(switch_at, "switch-at");
        d.pin(switch_below, "switch-below");
        d.pin(switch_inverted, "switch-inverted");
        d.pin(press, "press");
        d.pin(contact, "switch");
        d.pin(slipped, "slipped");
        d.pin(hit, "hit");
        d.pin(table, "table");
        d.function<&PlantStepper::update>(this);
    }

    void update(long period_ns) noexcept {
        if (!isPlaced) {
            axis.place(start);
            isPlaced = true;
        }
        axis.set({units_per_step, backlash, peak_acceleration, fastest, lower_end, upper_end, microsteps});
        const bool edge = step && !was_high;
        was_high = step;
        axis.run(edge ? (dir ? -1 : 1) : 0, powered, static_cast<double>(period_ns) * 1e-9);
        table = axis.table();
        slipped = axis.hasSlipped();
        hit = axis.hasHit();
        const bool actuated = press || (switch_below ? axis.table() < switch_at : axis.table() > switch_at);
        contact = actuated != switch_inverted;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantStepper, "plant_stepper", mw::sdk::MANY);
