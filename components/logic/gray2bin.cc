// SPDX-License-Identifier: GPL-2.0-or-later
// gray2bin: `out` is the number that `in` is in Gray code. Both u32.
#include "components/logic/gray.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Gray2bin {
    In<std::uint32_t> in;
    Out<std::uint32_t> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.function<&Gray2bin::update>(this);
    }
    void update() noexcept { out = logic::binary_of_gray(in); }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Gray2bin, "gray2bin", mw::sdk::MANY);
