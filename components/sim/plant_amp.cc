// SPDX-License-Identifier: GPL-2.0-or-later
// plant_amp: the power side of a drive.
#include "components/plants/amplifier.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantAmp {
    In<bool> enable, trip;
    In<double> rise_s;
    Out<bool> powered, fault;
    plants::Amplifier amplifier;

    void declare(Declare &d) noexcept {
        d.pin(enable, "enable");
        d.pin(trip, "trip");
        d.pin(rise_s, "rise-s");
        d.pin(powered, "powered");
        d.pin(fault, "fault");
        d.function<&PlantAmp::update>(this);
    }
    void update(long period_ns) noexcept {
        amplifier.set_rise(rise_s);
        if (trip) {
            amplifier.trip();
        }
        powered = amplifier.run(enable, static_cast<double>(period_ns) * 1e-9);
        if (!trip && amplifier.isFaulted()) {
            amplifier.reset();
        }
        fault = amplifier.isFaulted();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantAmp, "plant_amp", mw::sdk::MANY);
