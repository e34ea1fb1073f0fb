// SPDX-License-Identifier: GPL-2.0-or-later
// updown: `count` (s32) increases by one at each rising edge of `countup` (bit) and decreases at each of
// `countdown`;
// it is 0 while `reset` (bit) is true.
// Parameters: `clamp` (bit) keeps count between `min` (s32, 0) and `max` (s32, 2147483647); `wrap` (bit,
// takes priority over clamp) continues at the other end instead. Without both, the count overflows as its
// type does.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Updown {
    In<bool> countup, countdown, reset;
    Out<std::int32_t> count;
    ParamRw<bool> clamp, wrap;
    ParamRw<std::int32_t> max, min;
    bool last_up = true;  // an input that is TRUE in the first period is not an edge
    bool last_down = true;

    void declare(Declare &d) noexcept {
        d.pin(countup, "countup");
        d.pin(countdown, "countdown");
        d.pin(reset, "reset");
        d.pin(count, "count");
        d.param(clamp, "clamp");
        d.param(wrap, "wrap");
        d.param(max, "max", 0x7fffffff);
        d.param(min, "min");
        d.function<&Updown::update>(this);
    }

    void update() noexcept {
        const bool up = countup;
        const bool down = countdown;
        std::int64_t number = count;
        number += up && !last_up ? 1 : 0;
        number -= down && !last_down ? 1 : 0;
        last_up = up;
        last_down = down;
        count = static_cast<std::int32_t>(bounded(reset ? 0 : number));
    }

  private:
    std::int64_t bounded(std::int64_t number) const noexcept {
        if (wrap) {
            return number > max ? min.get() : (number < min ? max.get() : number);
        }
        if (clamp) {
            return number > max ? max.get() : (number < min ? min.get() : number);
        }
        return number;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Updown, "updown", mw::sdk::MANY);
