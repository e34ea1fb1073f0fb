// SPDX-License-Identifier: GPL-2.0-or-later
// reset: sets I/O pins to values when `trigger` (bit) becomes true.
//
// `out-bit`, `out-float`, `out-s32`, `out-u32` (I/O pins of those types) get the values of the inputs
// `reset-bit`, `reset-float`, `reset-s32`, `reset-u32`; only the linked ones matter. While `retriggerable`
// (bit) is true they are set in every period that trigger is true, not only in the first.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Reset {
    In<bool> trigger, retriggerable;
    InOut<bool> out_bit;
    InOut<double> out_float;
    InOut<std::int32_t> out_s32;
    InOut<std::uint32_t> out_u32;
    In<bool> reset_bit;
    In<double> reset_float;
    In<std::int32_t> reset_s32;
    In<std::uint32_t> reset_u32;
    bool last_trigger = false;

    void declare(Declare &d) noexcept {
        d.pin(trigger, "trigger");
        d.pin(retriggerable, "retriggerable");
        d.pin(out_bit, "out-bit");
        d.pin(out_float, "out-float");
        d.pin(out_s32, "out-s32");
        d.pin(out_u32, "out-u32");
        d.pin(reset_bit, "reset-bit");
        d.pin(reset_float, "reset-float");
        d.pin(reset_s32, "reset-s32");
        d.pin(reset_u32, "reset-u32");
        d.function<&Reset::update>(this);
    }

    void update() noexcept {
        const bool triggered = trigger;
        if (triggered && (!last_trigger || retriggerable)) {
            out_bit = reset_bit.get();
            out_float = reset_float.get();
            out_s32 = reset_s32.get();
            out_u32 = reset_u32.get();
        }
        last_trigger = triggered;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Reset, "reset", mw::sdk::MANY);
