// SPDX-License-Identifier: GPL-2.0-or-later
// mux16: `out-f` (float) follows the input of `in00` to `in15` (float) that `sel3` to `sel0` (bit) select;
// `out-s` (s32) is its whole part, the nearest possible value if it does not fit.
// `use-graycode` (bit): the number is in Gray code. `suppress-no-input` (bit): selection 0 changes
// nothing. A selection becomes active when it has been constant for `debounce-time` [s]; until then the
// outputs keep
// their values. Parameters `elapsed` [s] and `selected` (s32) show the debouncing.
#include "components/conv/conv_core.hh"
#include "components/logic/gray.hh"
#include "components/mux/selector.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Mux16 {
    static constexpr int INPUTS = 16;
    static constexpr int SELECT_BITS = 4;
    In<bool> use_graycode, suppress;
    In<double> debounce_time;
    In<bool> sel[SELECT_BITS];
    Out<double> out_f;
    Out<std::int32_t> out_s;
    In<double> in[INPUTS];
    ParamRo<double> elapsed;
    ParamRo<std::int32_t> selected;
    mux::Selector selector;

    void declare(Declare &d) noexcept {
        d.pin(use_graycode, "use-graycode");
        d.pin(suppress, "suppress-no-input");
        d.pin(debounce_time, "debounce-time");
        for (int i = 0; i < SELECT_BITS; ++i) {
            d.pin_at(sel[i], "sel%d", i);
        }
        d.pin(out_f, "out-f");
        d.pin(out_s, "out-s");
        for (int i = 0; i < INPUTS; ++i) {
            d.pin_at(in[i], "in%02d", i);
        }
        d.param(elapsed, "elapsed");
        d.param(selected, "selected");
        d.function<&Mux16::update>(this);
    }

    void update(long period_ns) noexcept {
        std::uint32_t wanted = mux::index_of_bits(sel[0].get(), sel[1].get(), sel[2].get(), sel[3].get());
        if (use_graycode) {
            wanted = logic::binary_of_gray(wanted);
        }
        const std::uint32_t debounce_us = conv::convert<std::uint32_t>(debounce_time * 1e6, true).value;
        const std::uint32_t chosen = selector.run(wanted, INPUTS, debounce_us, suppress, period_ns);
        if (selector.is_settled()) {
            const double value = in[chosen];
            out_f = value;
            out_s = conv::convert<std::int32_t>(value, true).value;
        }
        elapsed = selector.waited_us() * 1e-6;
        selected = static_cast<std::int32_t>(chosen);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Mux16, "mux16", mw::sdk::MANY);
