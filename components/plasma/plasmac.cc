// SPDX-License-Identifier: GPL-2.0-or-later
// plasmac: the controller of a plasma table as a HAL component. The algorithm is in plasma_core.hh; this file
// has the pins (plasma_pins.hh), the function, and the messages for the operator.
#include "components/plasma/plasma_core.hh"
#include "components/plasma/plasma_pins.hh"

namespace mw::components {
using namespace sdk;

namespace {
const char *text_of(plasma::Fault fault) noexcept {
    using plasma::Fault;
    switch (fault) {
    case Fault::NONE: return "";
    case Fault::NO_ARC: return "no arc after arc-max-starts starts";
    case Fault::ARC_LOST: return "the arc went out in the cut";
    case Fault::BREAKAWAY: return "the torch broke away";
    case Fault::FLOAT_SWITCH: return "the float switch closed";
    case Fault::OHMIC_PROBE: return "the ohmic probe has contact";
    case Fault::NO_MATERIAL: return "Z is at its lower end and found no material";
    case Fault::HEIGHTS_MISSING: return "pierce-height, cut-height and cut-volts must be above zero";
    case Fault::TOO_HIGH: return "the material is too high for the pierce height";
    case Fault::THC_AT_BOTTOM: return "the height control brought Z to its lower end";
    case Fault::THC_AT_TOP: return "the height control brought Z to its upper end";
    case Fault::VOLTAGE_LOW: return "the arc voltage fell below low-cut-volts";
    case Fault::NOT_A_NUMBER:
        return "an input is no number, or units-per-mm, resolution or gcode-scale is not above zero";
    case Fault::SENSOR_BEFORE_TEST: return "a sensor is closed: no probe test";
    }
    return "";
}
}  // namespace

struct Plasmac {
    PinSet<plasma::INPUT_PINS> inputs;
    PinSet<plasma::OUTPUT_PINS> outputs;
    plasma::Inputs in;
    plasma::Core core;
    std::int32_t shown_state = 0;

    int load(int comp_id) noexcept {
        const int status = inputs.declare(comp_id, 0);
        if (status < 0) {
            return status;
        }
        const int other = outputs.declare(comp_id, 0);
        if (other < 0) {
            return other;
        }
        Declare d(comp_id, "plasmac", 0);
        d.function<&Plasmac::update>(this);
        return d.status();
    }

    void update(long period_ns) noexcept {
        in.are_numbers = true;
        inputs.read(in);
        core.step(in, seconds(period_ns));
        outputs.write(core.out());
        tell();
    }

    void tell() noexcept {
        const plasma::Fault fault = core.take_fault();
        if (fault != plasma::Fault::NONE) {
            rtapi_print_msg(RTAPI_MSG_ERR, "plasmac: %s", text_of(fault));
        }
        const std::int32_t state = core.out().state_out;
        if (in.debug_print && state != shown_state) {
            rtapi_print_msg(RTAPI_MSG_ERR, "plasmac: state %d", static_cast<int>(state));
        }
        shown_state = state;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Plasmac, "plasmac");
