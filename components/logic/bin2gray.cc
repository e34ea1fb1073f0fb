// SPDX-License-Identifier: GPL-2.0-or-later
// bin2gray: `out` is `in` in Gray code. Both u32.
#include "components/common/kit.hh"
#include "components/logic/gray.hh"

namespace mw::components {

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

MW_INSTANCES(Bin2gray, "bin2gray");
