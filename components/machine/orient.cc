// SPDX-License-Identifier: GPL-2.0-or-later
// orient: the target position for stopping a spindle at an angle, for a position loop (M19).
// A rising edge of `enable` (bit) samples `position` [turns] and sets `command` [turns] to the next position
// with
// the angle `angle` [degrees]: `mode` (s32) 0 the nearer one, 1 forwards (to larger numbers), 2 backwards.
// While enabled `poserr` is the distance of `position` from it [degrees] and `is-oriented` (bit) is true
// within `tolerance` [degrees] (0.5 at start). Other pins are float.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Orient {
    In<bool> enable;
    In<std::int32_t> mode;
    In<double> position, angle, tolerance;
    Out<double> command, poserr;
    Out<bool> is_oriented;
    bool was_enabled = false;

    void declare(Declare &d) noexcept {
        d.pin(enable, "enable");
        d.pin(mode, "mode");
        d.pin(position, "position");
        d.pin(angle, "angle");
        d.pin(command, "command");
        d.pin(poserr, "poserr");
        d.pin(is_oriented, "is-oriented");
        d.pin(tolerance, "tolerance", 0.5);
        d.function<&Orient::update>(this);
    }

    void update() noexcept {
        const bool enabled = enable;
        const double now = position;
        if (enabled && !was_enabled) {
            const double wanted = target(now);
            command = std::isfinite(wanted) ? wanted : command.get();
        }
        was_enabled = enabled;
        if (enabled) {
            poserr = (now - command) * 360.0;
        }
        is_oriented = enabled && std::fabs(poserr) < tolerance;
    }

  private:
    double target(double now) const noexcept {
        const double same_turn = std::floor(now) + angle / 360.0;
        switch (mode) {
        case 1: return same_turn < now ? same_turn + 1.0 : same_turn;
        case 2: return same_turn > now ? same_turn - 1.0 : same_turn;
        default: break;
        }
        const double way = same_turn - now;
        return way > 0.5 ? same_turn - 1.0 : (way < -0.5 ? same_turn + 1.0 : same_turn);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Orient, "orient", mw::sdk::MANY);
