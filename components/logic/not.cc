// SPDX-License-Identifier: GPL-2.0-or-later
// not: `out` is the inverse of `in`. All pins bit.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Not {
    In<bool> in;
    Out<bool> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.function<&Not::update>(this);
    }
    void update() noexcept { out = !in; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Not, "not", mw::sdk::MANY);
