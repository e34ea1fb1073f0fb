// SPDX-License-Identifier: GPL-2.0-or-later
// dbounce: `out` follows `in` (bit) when `in` has been constant: a counter increases while in is true and
// decreases while it is false; at `delay` (u32, 5 at start) [periods] out becomes true, at 0 false.
#include "components/logic/debouncer.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Dbounce {
    In<bool> in;
    Out<bool> out;
    In<std::uint32_t> delay;
    logic::Debouncer debouncer;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(delay, "delay", 5U);
        d.function<&Dbounce::update>(this);
    }
    void update() noexcept { out = debouncer.run(in, static_cast<long>(delay.get())); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Dbounce, "dbounce", mw::sdk::MANY);
