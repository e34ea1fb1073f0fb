// SPDX-License-Identifier: GPL-2.0-or-later
// demux_generic: demultiplexers of any size, from any type to any type.
//
// `config=` as for mux_generic: two type letters (b bit, f float, s s32, u u32, l s64, k u64), from and to,
// and the number of outputs (2 to 1024), as in "ff8,b2f". Pins of demux-gen.NN: in-TYPE, out-TYPE-MM; sel-int
// (u32) plus sel-bit-MM give the number of the output that follows the input, the last one when it is too
// large; the others keep their value, or are 0 while the parameter zero-others (bit) is true.
// suppress-no-input selects nothing while that number is 0; debounce-us (u32) is how long a selection must be
// stable [us]. Parameters elapsed [us] and selected (u32) show the debouncing.
#include "components/mux/generic.hh"
#include "components/mux/selector.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_MUXES = 64;
static char *config[MAX_MUXES];
RTAPI_MP_ARRAY_STRING(config, MAX_MUXES, "from, to and size of each demultiplexer, such as ff8,b2f");

namespace mw::components {
using namespace sdk;

struct DemuxGeneric {
    Config shape;
    int select_bits = 0;
    mux::Selector selector;
    In<bool> suppress;
    In<std::uint32_t> debounce_us, sel_int;
    In<bool> sel_bit[MAX_SELECT_BITS];
    ParamRo<std::uint32_t> elapsed, selected;
    ParamRw<bool> zero_others;
    hal_data_u *input = nullptr;
    hal_data_u **outputs = nullptr;  ///< `shape.size` slots

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;
};

void DemuxGeneric::declare(Declare &d) noexcept {
    outputs = static_cast<hal_data_u **>(hal_malloc(static_cast<long>(sizeof(void *)) * shape.size));
    if (outputs == nullptr) {
        d.keep(-ENOMEM);
        return;
    }
    char name[HAL_NAME_LEN + 1];
    for (int i = 0; i < shape.size; ++i) {
        rtapi_snprintf(name, sizeof name, "%s.out-%s-%02d", d.prefix(), shape.to->name, i);
        d.keep(
            hal_pin_new(name, shape.to->type, HAL_OUT, reinterpret_cast<void **>(&outputs[i]), d.comp_id()));
    }
    rtapi_snprintf(name, sizeof name, "%s.in-%s", d.prefix(), shape.from->name);
    d.keep(hal_pin_new(name, shape.from->type, HAL_IN, reinterpret_cast<void **>(&input), d.comp_id()));
    d.param(zero_others, "zero-others");
    d.pin(suppress, "suppress-no-input");
    d.pin(debounce_us, "debounce-us");
    d.pin(sel_int, "sel-int");
    while (select_bits < MAX_SELECT_BITS && (2 << select_bits) <= shape.size) {
        rtapi_snprintf(name, sizeof name, "sel-bit-%02d", select_bits);
        d.pin(sel_bit[select_bits], name);
        ++select_bits;
    }
    d.param(elapsed, "elapsed");
    d.param(selected, "selected");
    d.function<&DemuxGeneric::update>(this);
}

void DemuxGeneric::update(long period_ns) noexcept {
    std::uint32_t wanted = sel_int;
    for (int i = 0; i < select_bits; ++i) {
        wanted += sel_bit[i] ? 1U << i : 0U;
    }
    const std::uint32_t chosen =
        selector.run(wanted, static_cast<std::uint32_t>(shape.size), debounce_us, suppress, period_ns);
    elapsed = selector.waited_us();
    selected = selector.selected();
    const bool none = suppress && wanted == 0;
    for (int i = 0; zero_others && i < shape.size; ++i) {
        copy_value(0, shape.to->type, outputs[i]);
    }
    if (!none) {
        copy_pin(input, shape.from->type, shape.to->type, outputs[chosen]);
    }
}

}  // namespace mw::components

static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id = mw::components::load_generic<mw::components::DemuxGeneric>("demux_generic", "demux-gen",
                                                                            config, MAX_MUXES);
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    hal_exit(mw_comp_id);
}
