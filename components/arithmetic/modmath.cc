// SPDX-License-Identifier: GPL-2.0-or-later
// modmath: the shorter direction from one number to another on a circle of numbers, as for a turret.
// The circle is `min-num` to `max-num` (s32 parameters, 0 and 15). While `actual` differs from
// `desired` (s32), one of `up` and `down` (bit) is true: the direction with fewer steps, or up if both are
// equal. Without `wrap` (bit parameter, true) it is the direction of the difference. If they are equal,
// `on-target`
// (bit) is true. A number outside the circle, or an empty circle, sets neither a direction nor on-target.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Modmath {
    In<std::int32_t> actual, desired;
    Out<bool> up, down, on_target;
    ParamRw<std::int32_t> max_num, min_num;
    ParamRw<bool> wrap;

    void declare(Declare &d) noexcept {
        d.pin(actual, "actual");
        d.pin(desired, "desired");
        d.pin(up, "up");
        d.pin(down, "down");
        d.pin(on_target, "on-target");
        d.param(max_num, "max-num", 15);
        d.param(min_num, "min-num");
        d.param(wrap, "wrap", true);
        d.function<&Modmath::update>(this);
    }

    void update() noexcept {
        const std::int64_t from = actual;
        const std::int64_t to = desired;
        const std::int64_t size = std::int64_t{max_num} - min_num + 1;
        const bool inside = isOnCircle(from) && isOnCircle(to);
        std::int64_t steps = to - from;
        if (wrap && size > 0) {
            steps = (steps % size + size) % size;
            steps = 2 * steps > size ? steps - size : steps;
        }
        up = inside && steps > 0;
        down = inside && steps < 0;
        on_target = inside && steps == 0;
    }

  private:
    bool isOnCircle(std::int64_t number) const noexcept { return min_num <= number && number <= max_num; }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Modmath, "modmath", mw::sdk::MANY);
