// SPDX-License-Identifier: GPL-2.0-or-later
// constant: `out` (float) is the parameter `value`.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Constant {
    Out<double> out;
    ParamRw<double> value;

    void declare(Declare &d) noexcept {
        d.pin(out, "out");
        d.param(value, "value");
        d.function<&Constant::update>(this);
    }
    void update() noexcept { out = value.get(); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Constant, "constant", mw::sdk::MANY);
