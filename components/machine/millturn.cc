// SPDX-License-Identifier: GPL-2.0-or-later
// millturn: kinematics of a mill-turn machine with three linear joints X Y Z and one rotary A. Type 0 (mill):
// joints are the axes X Y Z A. Type 1 (turn): joint 0 is Z, joint 1 is -Y, joint 2 is X, and A is a spindle.
// Switched by motion.switchkins-type. Pins kinstype.is-0 and is-1 (bit, out) show which is active;
// `millturn.0.fpin` (s32) counts runs of the function millturn.0.fdemo.
#include <atomic>

#include "hal/include/kinematics.h"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Millturn {
    Out<std::int32_t> fpin;
    Out<bool> is_type[2];  ///< pins of the first instance

    void declare(Declare &d) noexcept;
    void demo() noexcept { fpin = next_count(fpin); }
};

}  // namespace mw::components

namespace {

enum MillturnType { MILL = 0, TURN = 1 };
// The servo thread writes this when motion switches; the planner thread also reads it.
std::atomic<int> current_type{MILL};
mw::components::Millturn *first_instance = nullptr;

}  // namespace

void mw::components::Millturn::declare(Declare &d) noexcept {
    d.pin(fpin, "fpin");
    d.function<&Millturn::demo>(this, "fdemo");
    if (d.index() > 0) {
        return;
    }
    Declare types(d.comp_id(), "kinstype", 0);
    types.pin(is_type[MILL], "is-0", true);
    types.pin(is_type[TURN], "is-1", false);
    if (d.keep(types.status())) {
        first_instance = this;
    }
}

extern "C" {

int kinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *,
                      KINEMATICS_INVERSE_FLAGS *) {
    const bool is_turn = current_type == TURN;
    world->tran.x = is_turn ? joint[2] : joint[0];
    world->tran.y = is_turn ? -joint[1] : joint[1];
    world->tran.z = is_turn ? joint[0] : joint[2];
    world->a = joint[3];
    world->b = world->c = world->u = world->v = world->w = 0.0;
    return 0;
}

int kinematicsInverse(const struct EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *,
                      KINEMATICS_FORWARD_FLAGS *) {
    const bool is_turn = current_type == TURN;
    joint[0] = is_turn ? world->tran.z : world->tran.x;
    joint[1] = is_turn ? -world->tran.y : world->tran.y;
    joint[2] = is_turn ? world->tran.x : world->tran.z;
    joint[3] = world->a;
    return 0;
}

int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,
                   KINEMATICS_INVERSE_FLAGS *iflags) {
    return kinematicsForward(joint, world, fflags, iflags);
}

RTAPI_EXPORT int mw_kinematics_is_pure(void) {
    return 1;
}

KINEMATICS_TYPE kinematicsType(void) {
    return KINEMATICS_BOTH;
}

int kinematicsSwitchable(void) {
    return 1;
}

int kinematicsSwitch(int switchkins_type) {
    if (switchkins_type != MILL && switchkins_type != TURN) {
        return -1;
    }
    current_type = switchkins_type;
    if (first_instance != nullptr) {
        first_instance->is_type[MILL] = switchkins_type == MILL;
        first_instance->is_type[TURN] = switchkins_type == TURN;
    }
    return 0;
}

EXPORT_SYMBOL(kinematicsSwitchable);
EXPORT_SYMBOL(kinematicsSwitch);
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
EXPORT_SYMBOL(kinematicsType);
}

MW_COMPONENT(mw::components::Millturn, "millturn", mw::sdk::MANY);
