// SPDX-License-Identifier: GPL-2.0-or-later
// ohmic: detects that a plasma torch touches the plate, from the frequency of a voltage converter (THCAD).
// `thcad-volts` is `thcad-fullscale` (5) times the position of `velocity-in` [Hz] times `thcad-divide` (32)
// in the range from `thcad-0-volt-freq` to `thcad-max-volt-freq` [Hz]; `ohmic-volts` is `thcad-volts` times
// `volt-divider` (4.9). `ohmic-on` (bit) becomes true while `is-probing` (bit) is true and ohmic-volts are at
// least `ohmic-threshold` (18), false when they are below `ohmic-low` (5). `arc-on` (bit): thcad-volts are at
// least the full scale. Volts that are not a number count as contact while probing, so that the torch stops.
// Other pins are float.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Ohmic {
    In<double> zero_freq, max_freq, divide, fullscale, velocity_in, volt_divider, threshold, low;
    Out<bool> arc_on, ohmic_on;
    Out<double> thcad_volts, ohmic_volts;
    In<bool> is_probing;

    void declare(Declare &d) noexcept {
        d.pin(zero_freq, "thcad-0-volt-freq");
        d.pin(max_freq, "thcad-max-volt-freq");
        d.pin(divide, "thcad-divide", 32.0);
        d.pin(fullscale, "thcad-fullscale", 5.0);
        d.pin(velocity_in, "velocity-in");
        d.pin(volt_divider, "volt-divider", 4.9);
        d.pin(threshold, "ohmic-threshold", 18.0);
        d.pin(low, "ohmic-low", 5.0);
        d.pin(arc_on, "arc-on");
        d.pin(thcad_volts, "thcad-volts");
        d.pin(ohmic_volts, "ohmic-volts");
        d.pin(ohmic_on, "ohmic-on");
        d.pin(is_probing, "is-probing");
        d.function<&Ohmic::update>(this);
    }

    void update() noexcept {
        const double span = max_freq - zero_freq;
        const double volts = fullscale * (velocity_in * divide - zero_freq) / span;
        const double sensed = volts * volt_divider;
        thcad_volts = volts;
        ohmic_volts = sensed;
        arc_on = volts >= fullscale;
        const bool is_touch = !(sensed < threshold);  // true for NaN
        if (is_probing && is_touch) {
            ohmic_on = true;
        } else if (sensed < low) {
            ohmic_on = false;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Ohmic, "ohmic", mw::sdk::MANY);
