// SPDX-License-Identifier: GPL-2.0-or-later
// sim_spindle: a spindle that follows its command at once, with an index.
// `velocity-cmd` times the parameter `scale` (1 at start) is the speed in turns per second; `position-fb` the
// position [turns]. With `index-enable` (bit, I/O) set, the position restarts at the next whole turn and
// the pin is cleared.
#include "components/plants/spindle.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SimSpindle {
    In<double> velocity_cmd;
    Out<double> position_fb;
    InOut<bool> index_enable;
    ParamRw<double> scale;
    plants::Spindle spindle;

    void declare(Declare &d) noexcept {
        d.pin(velocity_cmd, "velocity-cmd");
        d.pin(position_fb, "position-fb");
        d.pin(index_enable, "index-enable");
        d.param(scale, "scale", 1.0);
        d.function<&SimSpindle::update>(this);
    }

    void update(long period_ns) noexcept {
        if (spindle.run(velocity_cmd * scale, index_enable, static_cast<double>(period_ns) * 1e-9)) {
            index_enable = false;
        }
        position_fb = spindle.position();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SimSpindle, "sim_spindle", mw::sdk::MANY);
