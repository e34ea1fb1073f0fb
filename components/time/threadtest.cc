// SPDX-License-Identifier: GPL-2.0-or-later
// threadtest: counts runs. Function threadtest.N.increment adds one to `count` (u32), threadtest.N.reset sets
// it to 0.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Threadtest {
    Out<std::uint32_t> count;

    void declare(Declare &d) noexcept {
        d.pin(count, "count");
        d.function<&Threadtest::increment>(this, "increment");
        d.function<&Threadtest::reset>(this, "reset");
    }
    void increment() noexcept { count = count + 1; }
    void reset() noexcept { count = 0; }
};

}  // namespace mw::components

MW_MODULE("threadtest", count, 1, mw::sdk::MANY, mw::sdk::load_instances<mw::components::Threadtest>);
