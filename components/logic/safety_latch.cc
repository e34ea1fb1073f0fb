// SPDX-License-Identifier: GPL-2.0-or-later
// safety_latch: an error that lasts, or occurs too often, causes a fault that remains until it is reset.
// In each period a counter increases by `harm` while `error-in` (bit) is true and decreases by `heal` while
// it is
// false, from 0 to `max`. When it reaches `threshold`, `error-out` becomes true and `ok-out` false;
// `latching` (bit, true at start) keeps that until a rising edge of `reset` (bit) while error-in is false,
// which also clears the counter; otherwise the fault ends when the counter is 0. `count` (u32) is the
// counter. While `enable` (bit, true at start) is false, the state is faulted: ok-out is false. It starts
// faulted with latching: reset it once. harm, heal (1), threshold (1) and max (100) are u32 inputs. Software
// can only support an emergency stop chain; it cannot replace one.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SafetyLatch {
    In<bool> enable, error_in, reset, latching;
    Out<bool> error_out, ok_out;
    Out<std::uint32_t> count;
    In<std::uint32_t> harm, heal, threshold, max;
    std::uint32_t counter = 0;
    bool isFaulted = true;
    bool last_reset = false;

    void declare(Declare &d) noexcept {
        d.pin(enable, "enable", true);
        d.pin(error_in, "error-in");
        d.pin(reset, "reset");
        d.pin(latching, "latching", true);
        d.pin(error_out, "error-out", true);
        d.pin(ok_out, "ok-out");
        d.pin(count, "count");
        d.pin(harm, "harm", 1U);
        d.pin(heal, "heal", 1U);
        d.pin(threshold, "threshold", 1U);
        d.pin(max, "max", 100U);
        d.function<&SafetyLatch::update>(this);
    }

    void update() noexcept {
        const bool is_error = error_in;
        const bool is_reset = reset && !last_reset;
        last_reset = reset;
        count_error(is_error);
        const bool released = latching ? (is_reset && !is_error) : counter == 0;
        counter = released ? 0 : counter;
        const bool is_too_much = counter >= threshold && (counter > 0 || is_error);
        if (is_too_much || !enable) {
            isFaulted = true;
        } else if (released) {
            isFaulted = false;
        }
        error_out = isFaulted;
        ok_out = !isFaulted;
        count = counter;
    }

  private:
    void count_error(bool is_error) noexcept {
        const std::uint32_t limit = max > threshold ? max.get() : threshold.get();
        const std::uint32_t down = heal;
        if (is_error) {
            const std::uint64_t sum = std::uint64_t{counter} + harm;
            counter = sum < limit ? static_cast<std::uint32_t>(sum) : limit;
        } else {
            counter = counter > down ? counter - down : 0;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SafetyLatch, "safety_latch", mw::sdk::MANY);
