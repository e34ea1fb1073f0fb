// SPDX-License-Identifier: GPL-2.0-or-later
// thcud: torch height control with up and down signals from another controller: adds a correction to the Z
// axis of a plasma cutter.
//
// While `enable`, `torch-on` and `arc-ok` (bit) are true and `vel-status` (bit) is true (`current-vel` is at
// least `requested-vel` minus `velocity-tol` percent), the torch moves by `correction-vel` a period up while
// `torch-up` (bit) is true, down while `torch-down` is (not at all while both are). When the torch is off the
// correction is removed while Z rises (`removing-offset`, bit); while enable is false, by correction-vel a
// period. `z-pos-out` = `z-pos-in` + `cur-offset`; `z-fb-out` = z-pos-in. Others float; velocity-tol and
// correction-vel are parameters.
#include "components/machine/torch.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Thcud {
    In<bool> torch_up, torch_down;
    In<double> current_vel, requested_vel;
    In<bool> torch_on, arc_ok, enable;
    In<double> z_pos_in;
    Out<double> z_pos_out, z_fb_out, cur_offset;
    Out<bool> vel_status, removing_offset;
    ParamRw<double> velocity_tol, correction_vel;
    torch::Correction correction;

    int load(int comp_id) noexcept {
        Declare d(comp_id, "thcud", 0);
        d.pin(torch_up, "torch-up");
        d.pin(torch_down, "torch-down");
        d.pin(current_vel, "current-vel");
        d.pin(requested_vel, "requested-vel");
        d.pin(torch_on, "torch-on");
        d.pin(arc_ok, "arc-ok");
        d.pin(enable, "enable");
        d.pin(z_pos_in, "z-pos-in");
        d.pin(z_pos_out, "z-pos-out");
        d.pin(z_fb_out, "z-fb-out");
        d.pin(cur_offset, "cur-offset");
        d.pin(vel_status, "vel-status");
        d.pin(removing_offset, "removing-offset");
        d.param(velocity_tol, "velocity-tol");
        d.param(correction_vel, "correction-vel");
        d.function<&Thcud::update>(this);
        return d.status();
    }

    void update() noexcept {
        vel_status = torch::isAtSpeed(current_vel, requested_vel, velocity_tol);
        const int wanted = (torch_up ? 1 : 0) - (torch_down ? 1 : 0);
        const double z = z_pos_in;
        set_finite(z_pos_out,
                   correction.run(z, enable, torch_on && arc_ok, vel_status ? wanted : 0, correction_vel));
        set_finite(z_fb_out, z);
        cur_offset = correction.offset;
        removing_offset = correction.removing;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Thcud, "thcud");
