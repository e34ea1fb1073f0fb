// SPDX-License-Identifier: GPL-2.0-or-later
// edge: `out` (bit) is true for a time after an edge of `in` (bit); `out-invert` is its opposite.
// Parameters: `both` detects both edges; otherwise `in-edge` selects, true (at start) the falling one, false
// the
// rising. `out-width-ns` is the length of the pulse [ns], rounded up to periods; 0 is one period.
// `time-left-ns` and `last-in` show the state. The level of `in` at the first call is not an edge.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Edge {
    In<bool> in;
    Out<bool> out, out_invert;
    ParamRw<bool> both, in_edge;
    ParamRw<std::int32_t> out_width_ns;
    ParamRo<std::int32_t> time_left_ns;
    ParamRo<bool> last_in;
    bool first = true;

    void declare(Declare &d) noexcept {
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(out_invert, "out-invert");
        d.param(both, "both");
        d.param(in_edge, "in-edge", true);
        d.param(out_width_ns, "out-width-ns");
        d.param(time_left_ns, "time-left-ns");
        d.param(last_in, "last-in");
        d.function<&Edge::update>(this);
    }

    void update(long period_ns) noexcept {
        const bool input = in;
        const bool changed = !first && input != last_in;
        const bool wanted = both || (in_edge ? !input : input);
        first = false;
        last_in = input;
        const std::int64_t left = std::int64_t{time_left_ns} - period_ns;
        time_left_ns = left > 0 ? static_cast<std::int32_t>(left) : 0;
        if (changed && wanted) {
            const std::int32_t width = out_width_ns;
            time_left_ns = width > 0 ? width : 1;
        }
        out = time_left_ns > 0;
        out_invert = !out;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Edge, "edge", mw::sdk::MANY);
