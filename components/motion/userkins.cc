// SPDX-License-Identifier: GPL-2.0-or-later
// userkins: joints 0 to 2 are the axes X Y Z. It serves until the user has built kinematics with this name;
// examples/kinematics/userkins.comp is the template. `userkins.0.fpin` (s32) counts runs of the function
// userkins.0.fdemo.
#include "components/motion/kinematics_module.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Userkins {
    Out<std::int32_t> fpin;

    void declare(Declare &d) noexcept {
        d.pin(fpin, "fpin");
        d.function<&Userkins::demo>(this, "fdemo");
    }
    void demo() noexcept { fpin = next_count(fpin); }
};

}  // namespace mw::components

extern "C" {

int kinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *,
                      KINEMATICS_INVERSE_FLAGS *) {
    *world = {{joint[0], joint[1], joint[2]}, 0, 0, 0, 0, 0, 0};
    return 0;
}

int kinematicsInverse(const struct EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *,
                      KINEMATICS_FORWARD_FLAGS *) {
    joint[0] = world->tran.x;
    joint[1] = world->tran.y;
    joint[2] = world->tran.z;
    return 0;
}

int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,
                   KINEMATICS_INVERSE_FLAGS *iflags) {
    return kinematicsForward(joint, world, fflags, iflags);
}

KINEMATICS_TYPE kinematicsType(void) {
    return KINEMATICS_IDENTITY;
}

KINS_NOT_SWITCHABLE
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
EXPORT_SYMBOL(kinematicsType);
}

MW_COMPONENT(mw::components::Userkins, "userkins", mw::sdk::MANY);
