// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of CoreXY machines: joint 0 = X + Y, joint 1 = X - Y, joints 2 to 8 = Z A B C U V W.
#include "hal/api/hal.h"
#include "hal/api/kinematics.h"
#include "hal/api/rtapi_app.h"
#include "kins/corexy.hh"

using mw::geom::Pose;

static const mw::kins::CoreXy model;
static int component = -1;

extern "C" int kinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *,
                                 KINEMATICS_INVERSE_FLAGS *) {
    Pose pose;
    model.forward(joint, pose);
    *world = {{pose[0], pose[1], pose[2]}, pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]};
    return 0;
}

extern "C" int kinematicsInverse(const struct EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *,
                                 KINEMATICS_FORWARD_FLAGS *) {
    const Pose pose{{world->tran.x, world->tran.y, world->tran.z, world->a, world->b, world->c, world->u,
                     world->v, world->w}};
    model.inverse(pose, joint);
    return 0;
}

extern "C" int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,
                              KINEMATICS_INVERSE_FLAGS *iflags) {
    return kinematicsForward(joint, world, fflags, iflags);
}

extern "C" KINEMATICS_TYPE kinematicsType(void) {
    return KINEMATICS_BOTH;
}

/// No hidden state: the planner may call these functions while the servo thread does.
extern "C" RTAPI_EXPORT int mw_kinematics_is_pure(void) {
    return 1;
}

extern "C" {
KINS_NOT_SWITCHABLE
}

int rtapi_app_main(void) {
    component = hal_init("corexykins");
    return component < 0 ? component : hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}
