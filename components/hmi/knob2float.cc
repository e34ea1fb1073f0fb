// SPDX-License-Identifier: GPL-2.0-or-later
// knob2float: an endless knob sets a value. While `enable` (bit) is true `out` changes by `scale` (float) for
// each count of `counts` (s32), limited to the parameters `min-out` (0) and `max-out` (1). Counts while
// enable is false, and those before the first run, are ignored.
#include "components/limit/limit_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Knob2float {
    In<std::int32_t> counts;
    In<bool> enable;
    In<double> scale;
    Out<double> out;
    ParamRw<double> max_out, min_out;
    std::int32_t last_counts = 0;
    bool first = true;

    void declare(Declare &d) noexcept {
        d.pin(counts, "counts");
        d.pin(enable, "enable");
        d.pin(scale, "scale");
        d.pin(out, "out");
        d.param(max_out, "max-out", 1.0);
        d.param(min_out, "min-out");
        d.function<&Knob2float::update>(this);
    }

    void update() noexcept {
        const std::int32_t now = counts;
        // Subtracted as unsigned, so that a wrap of the counter is one step.
        const std::int32_t turned = first
                                        ? 0
                                        : static_cast<std::int32_t>(static_cast<std::uint32_t>(now) -
                                                                    static_cast<std::uint32_t>(last_counts));
        first = false;
        last_counts = now;
        if (enable) {
            out = limit::between(out + turned * scale, min_out, max_out);
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Knob2float, "knob2float", mw::sdk::MANY);
