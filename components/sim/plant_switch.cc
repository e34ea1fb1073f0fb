// SPDX-License-Identifier: GPL-2.0-or-later
// plant_switch: a switch on an axis whose contact bounces.
#include "components/plants/bouncing_switch.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantSwitch {
    In<double> place, at, width, hysteresis, bounce_s;
    In<bool> below;
    Out<bool> contact, pressed;
    plants::BouncingSwitch lever;

    void declare(Declare &d) noexcept {
        d.pin(place, "place");
        d.pin(at, "at");
        d.pin(below, "below");
        d.pin(width, "width");
        d.pin(hysteresis, "hysteresis");
        d.pin(bounce_s, "bounce-s");
        d.pin(contact, "contact");
        d.pin(pressed, "pressed");
        // Each instance has its own random sequence, the same in every run.
        lever = plants::BouncingSwitch({}, static_cast<std::uint64_t>(d.index()) + 1);
        d.function<&PlantSwitch::update>(this);
    }
    void update(long period_ns) noexcept {
        lever.set({at, !below, width, hysteresis, bounce_s});
        contact = lever.run(place, static_cast<double>(period_ns) * 1e-9);
        pressed = lever.isPressed();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantSwitch, "plant_switch", mw::sdk::MANY);
