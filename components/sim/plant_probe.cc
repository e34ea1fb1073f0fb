// SPDX-License-Identifier: GPL-2.0-or-later
// plant_probe: a touch probe above a surface.
#include "components/plants/touch_probe.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantProbe {
    In<double> tip, surface, pretravel;
    In<bool> stuck_open, stuck_closed;
    Out<bool> contact;

    void declare(Declare &d) noexcept {
        d.pin(tip, "tip");
        d.pin(surface, "surface");
        d.pin(pretravel, "pretravel");
        d.pin(stuck_open, "stuck-open");
        d.pin(stuck_closed, "stuck-closed");
        d.pin(contact, "contact");
        d.function<&PlantProbe::update>(this);
    }
    void update() noexcept {
        using Fault = plants::TouchProbe::Fault;
        plants::TouchProbe probe(surface, pretravel);
        probe.set_fault(stuck_closed ? Fault::STUCK_CLOSED : stuck_open ? Fault::STUCK_OPEN : Fault::NONE);
        contact = probe.isClosed(tip);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantProbe, "plant_probe", mw::sdk::MANY);
