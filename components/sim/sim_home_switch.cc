// SPDX-License-Identifier: GPL-2.0-or-later
// sim_home_switch: a home switch and an index pulse for a simulated axis.
// `home-sw` (bit) becomes true when `cur-pos` reaches `home-pos` (1 at start; below it for a negative one)
// and
// false after a return by `hysteresis` (0.1 at start), all in machine units. `index-enable` (bit, I/O) is
// cleared `index-delay-ms` (10 at start) milliseconds after it was set.
#include "components/plants/home_switch.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SimHomeSwitch {
    In<double> cur_pos, home_pos, hysteresis;
    Out<bool> home_sw;
    InOut<bool> index_enable;
    In<double> index_delay_ms;
    plants::HomeSwitch home_switch;
    plants::DelayedIndex index;

    void declare(Declare &d) noexcept {
        d.pin(cur_pos, "cur-pos");
        d.pin(home_pos, "home-pos", 1.0);
        d.pin(hysteresis, "hysteresis", 0.1);
        d.pin(home_sw, "home-sw");
        d.pin(index_enable, "index-enable");
        d.pin(index_delay_ms, "index-delay-ms", 10.0);
        d.function<&SimHomeSwitch::update>(this);
    }

    void update(long period_ns) noexcept {
        home_sw = home_switch.run(cur_pos, home_pos, hysteresis);
        if (index.run(index_enable, index_delay_ms * 1e-3, static_cast<double>(period_ns) * 1e-9)) {
            index_enable = false;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SimHomeSwitch, "sim_home_switch", mw::sdk::MANY);
