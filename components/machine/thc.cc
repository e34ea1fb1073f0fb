// SPDX-License-Identifier: GPL-2.0-or-later
// thc: torch height control by the arc voltage: adds a correction to the Z axis of a plasma cutter.
//
// `volts` is (`encoder-vel` - `scale-offset`) * `vel-scale`. While `enable`, `torch-on` and `arc-ok` (bit)
// are true and `vel-status` (bit) is true (`current-vel` is at least `requested-vel` minus `velocity-tol`
// percent), the torch moves up by `correction-vel` a period when `volts` is below `volts-requested` by more
// than `voltage-tol`, and down when `volts` is above by more. When the torch is off the correction is removed
// while Z rises; while enable is false, by correction-vel a period. `z-pos-out` = `z-pos-in` +
// `offset-value`; `z-fb-out` = z-pos-in. Pins `vel-tol` (not used) and others float; vel-scale, scale-offset,
// velocity-tol, voltage-tol, correction-vel are parameters.
#include "components/machine/torch.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Thc {
    In<double> encoder_vel, current_vel, requested_vel, volts_requested, vel_tol;
    In<bool> torch_on, arc_ok, enable;
    In<double> z_pos_in;
    Out<double> z_pos_out, z_fb_out, volts;
    Out<bool> vel_status;
    Out<double> offset_value;
    ParamRw<double> vel_scale, scale_offset, velocity_tol, voltage_tol, correction_vel;
    torch::Correction correction;

    int load(int comp_id) noexcept {
        Declare d(comp_id, "thc", 0);
        d.pin(encoder_vel, "encoder-vel");
        d.pin(current_vel, "current-vel");
        d.pin(requested_vel, "requested-vel");
        d.pin(volts_requested, "volts-requested");
        d.pin(vel_tol, "vel-tol");
        d.pin(torch_on, "torch-on");
        d.pin(arc_ok, "arc-ok");
        d.pin(enable, "enable");
        d.pin(z_pos_in, "z-pos-in");
        d.pin(z_pos_out, "z-pos-out");
        d.pin(z_fb_out, "z-fb-out");
        d.pin(volts, "volts");
        d.pin(vel_status, "vel-status");
        d.pin(offset_value, "offset-value");
        d.param(vel_scale, "vel-scale");
        d.param(scale_offset, "scale-offset");
        d.param(velocity_tol, "velocity-tol");
        d.param(voltage_tol, "voltage-tol");
        d.param(correction_vel, "correction-vel");
        d.function<&Thc::update>(this);
        return d.status();
    }

    void update() noexcept {
        const double arc = (encoder_vel - scale_offset) * vel_scale;
        volts = arc;
        vel_status = torch::isAtSpeed(current_vel, requested_vel, velocity_tol);
        const bool cutting = torch_on && arc_ok;
        int direction = 0;
        if (vel_status) {
            direction = arc < volts_requested - voltage_tol   ? 1
                        : arc > volts_requested + voltage_tol ? -1
                                                              : 0;
        }
        const double z = z_pos_in;
        set_finite(z_pos_out, correction.run(z, enable, cutting, direction, correction_vel));
        set_finite(z_fb_out, z);
        offset_value = correction.offset;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Thc, "thc");
