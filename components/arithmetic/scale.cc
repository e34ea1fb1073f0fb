// SPDX-License-Identifier: GPL-2.0-or-later
// scale: out = in * gain + offset. All pins float.
#include "components/common/kit.hh"

namespace mw::components {

struct Scale {
    In<double> in, gain, offset;
    Out<double> out;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(gain, "gain");
        d.pin(offset, "offset");
        d.pin(out, "out");
        d.function<&Scale::update>(this);
    }
    void update() noexcept { out = in * gain + offset; }
};

}  // namespace mw::components

MW_INSTANCES(Scale, "scale");
