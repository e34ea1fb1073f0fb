// SPDX-License-Identifier: GPL-2.0-or-later
// corexy_by_hal: CoreXY kinematics between two joints and two motors: alpha = (j0 + j1) / 2, beta = (j0 - j1)
// / 2, and back for the feedback. Pins (float) [machine units]: j0-motor-pos-cmd, j1-motor-pos-cmd, alpha-fb,
// beta-fb; outputs alpha-cmd, beta-cmd, j0-motor-pos-fb, j1-motor-pos-fb.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct CorexyByHal {
    In<double> alpha_fb, beta_fb, j0_cmd, j1_cmd;
    Out<double> j0_fb, j1_fb, alpha_cmd, beta_cmd;

    void declare(Declare &d) noexcept {
        d.pin(alpha_fb, "alpha-fb");
        d.pin(beta_fb, "beta-fb");
        d.pin(j0_cmd, "j0-motor-pos-cmd");
        d.pin(j1_cmd, "j1-motor-pos-cmd");
        d.pin(j0_fb, "j0-motor-pos-fb");
        d.pin(j1_fb, "j1-motor-pos-fb");
        d.pin(alpha_cmd, "alpha-cmd");
        d.pin(beta_cmd, "beta-cmd");
        d.function<&CorexyByHal::update>(this);
    }

    void update() noexcept {
        const double x = j0_cmd;
        const double y = j1_cmd;
        const double alpha = alpha_fb;
        const double beta = beta_fb;
        set_finite(alpha_cmd, (x + y) / 2.0);
        set_finite(beta_cmd, (x - y) / 2.0);
        set_finite(j0_fb, alpha + beta);
        set_finite(j1_fb, alpha - beta);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::CorexyByHal, "corexy_by_hal", mw::sdk::MANY);
