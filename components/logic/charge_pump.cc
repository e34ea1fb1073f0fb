// SPDX-License-Identifier: GPL-2.0-or-later
// charge_pump: a square wave for hardware that checks whether the software is running.
// While `enable` (bit, true at start) is true, `out` toggles with every call, `out-2` with every second,
// `out-4` with every fourth; otherwise all are false. One instance, without number.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct ChargePump {
    In<bool> enable;
    Out<bool> out, out_2, out_4;
    unsigned calls = 0;

    void declare(Declare &d) noexcept {
        d.pin(enable, "enable", true);
        d.pin(out, "out");
        d.pin(out_2, "out-2");
        d.pin(out_4, "out-4");
        d.function<&ChargePump::update>(this);
    }

    void update() noexcept {
        const bool enabled = enable;
        calls += enabled ? 1U : 0U;
        out = enabled && (calls & 1U) != 0;
        out_2 = enabled && (calls & 2U) != 0;
        out_4 = enabled && (calls & 4U) != 0;
    }
};

}  // namespace mw::components

static int mw_comp_id = -1;

int rtapi_app_main(void) {
    static char name[] = "charge-pump";
    static char *const names[] = {name, nullptr};
    mw_comp_id =
        mw::sdk::load_instances<mw::components::ChargePump>({"charge_pump", "count", 0, names, 1, 1});
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    hal_exit(mw_comp_id);
}
