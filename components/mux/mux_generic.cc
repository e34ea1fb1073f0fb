// SPDX-License-Identifier: GPL-2.0-or-later
// mux_generic: multiplexers of any size, from any type to any type.
//
// `config=` is a comma-separated list, one item a multiplexer: two type letters (b bit, f float, s s32, u
// u32, l s64, k u64), from and to, and the number of inputs (2 to 1024) anywhere in the item, as in
// "ff8,b2f". Pins of mux-gen.NN: in-TYPE-MM, out-TYPE; sel-int (u32) plus sel-bit-MM give the number of the
// input, the last one when it is too large; suppress-no-input keeps the output while that number is 0;
// debounce-us (u32) is how long a selection must be stable [us]. Parameters elapsed [us] and selected (u32)
// show the debouncing. Values out of the range of the output become its nearest value.
#include "components/mux/generic.hh"
#include "components/mux/selector.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_MUXES = 64;
static char *config[MAX_MUXES];
RTAPI_MP_ARRAY_STRING(config, MAX_MUXES, "from, to and size of each multiplexer, such as ff8,b2f");

namespace mw::components {
using namespace sdk;

struct MuxGeneric {
    Config shape;
    int select_bits = 0;
    mux::Selector selector;
    In<bool> suppress;
    In<std::uint32_t> debounce_us, sel_int;
    In<bool> sel_bit[MAX_SELECT_BITS];
    ParamRo<std::uint32_t> elapsed, selected;
    hal_data_u **inputs = nullptr;  ///< `shape.size` slots
    hal_data_u *output = nullptr;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;
};

void MuxGeneric::declare(Declare &d) noexcept {
    inputs = static_cast<hal_data_u **>(hal_malloc(static_cast<long>(sizeof(void *)) * shape.size));
    if (inputs == nullptr) {
        d.keep(-ENOMEM);
        return;
    }
    char name[HAL_NAME_LEN + 1];
    for (int i = 0; i < shape.size; ++i) {
        rtapi_snprintf(name, sizeof name, "%s.in-%s-%02d", d.prefix(), shape.from->name, i);
        d.keep(
            hal_pin_new(name, shape.from->type, HAL_IN, reinterpret_cast<void **>(&inputs[i]), d.comp_id()));
    }
    rtapi_snprintf(name, sizeof name, "%s.out-%s", d.prefix(), shape.to->name);
    d.keep(hal_pin_new(name, shape.to->type, HAL_OUT, reinterpret_cast<void **>(&output), d.comp_id()));
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
    d.function<&MuxGeneric::update>(this);
}

void MuxGeneric::update(long period_ns) noexcept {
    std::uint32_t wanted = sel_int;
    for (int i = 0; i < select_bits; ++i) {
        wanted += sel_bit[i] ? 1U << i : 0U;
    }
    const std::uint32_t chosen =
        selector.run(wanted, static_cast<std::uint32_t>(shape.size), debounce_us, suppress, period_ns);
    elapsed = selector.waited_us();
    selected = selector.selected();
    if (selector.is_settled()) {
        copy_pin(inputs[chosen], shape.from->type, shape.to->type, output);
    }
}

}  // namespace mw::components

static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id =
        mw::components::load_generic<mw::components::MuxGeneric>("mux_generic", "mux-gen", config, MAX_MUXES);
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    hal_exit(mw_comp_id);
}
