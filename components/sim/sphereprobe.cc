// SPDX-License-Identifier: GPL-2.0-or-later
// sphereprobe: a probe over half a ball that exists only in numbers. `probe-out` (bit) is true while the tip
// at px, py, pz is inside the ball of radius `r` around cx, cy, cz, or below its middle plane. Inputs s32
// [counts].
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Sphereprobe {
    In<std::int32_t> px, py, pz, cx, cy, cz, r;
    Out<bool> probe_out;

    void declare(Declare &d) noexcept {
        d.pin(px, "px");
        d.pin(py, "py");
        d.pin(pz, "pz");
        d.pin(cx, "cx");
        d.pin(cy, "cy");
        d.pin(cz, "cz");
        d.pin(r, "r");
        d.pin(probe_out, "probe-out");
        d.function<&Sphereprobe::update>(this);
    }

    void update() noexcept {
        const double x = static_cast<double>(px) - cx;
        const double y = static_cast<double>(py) - cy;
        const double z = static_cast<double>(pz) - cz;
        const double radius = r;
        probe_out = z < 0.0 || x * x + y * y + z * z <= radius * radius;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Sphereprobe, "sphereprobe", mw::sdk::MANY);
