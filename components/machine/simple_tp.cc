// SPDX-License-Identifier: GPL-2.0-or-later
// simple_tp: moves one axis to a position within a speed and an acceleration.
// Function simple-tp.N.update: `current-pos` moves to `target-pos` with at most `maxvel` [per s] and
// `maxaccel` [per s^2] while `enable` (bit) is true, and stops with maxaccel when it is false. `current-vel`
// is its speed, `active` (bit) is true while it moves. Other pins are float. A target that is not a number,
// or a
// maxvel of 0 or less, stops it.
#include "components/machine/follower.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SimpleTp {
    In<double> target_pos, maxvel, maxaccel;
    In<bool> enable;
    Out<double> current_pos, current_vel;
    Out<bool> active;
    Follower follower;

    void declare(Declare &d) noexcept {
        d.pin(target_pos, "target-pos");
        d.pin(maxvel, "maxvel");
        d.pin(maxaccel, "maxaccel");
        d.pin(enable, "enable");
        d.pin(current_pos, "current-pos");
        d.pin(current_vel, "current-vel");
        d.pin(active, "active");
        d.function<&SimpleTp::update>(this, "update");
    }

    void update(long period_ns) noexcept {
        const double dt = seconds(period_ns);
        if (enable) {
            follower.run(target_pos, maxvel, maxaccel, dt);
        } else {
            follower.stop(maxaccel, dt);
        }
        current_pos = follower.position();
        current_vel = follower.velocity();
        active = follower.isMoving();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SimpleTp, "simple_tp", mw::sdk::MANY);
