// SPDX-License-Identifier: GPL-2.0-or-later
// bin2gray: `out` is `in` in Gray code. Both u32.
#include "components/logic/gray.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Bin2gray {
    In<std::uint32_t> in;
    Out<std::uint32_t> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.function<&Bin2gray::update>(this);
    }
    void update() noexcept { out = logic::gray_of(in); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Bin2gray, "bin2gray", mw::sdk::MANY);
