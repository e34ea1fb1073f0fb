/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Kinematics as users write them in C: the first joint moves by a tenth of Y. */
#include "hal.h"
#include "kinematics.h"
#include "rtapi.h"
#include "rtapi_app.h"

static int comp_id;

int kinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *fflags,
                      KINEMATICS_INVERSE_FLAGS *iflags) {
    (void)fflags;
    (void)iflags;
    world->tran.x = joint[0] - 0.1 * joint[1];
    world->tran.y = joint[1];
    world->tran.z = joint[2];
    return 0;
}

int kinematicsInverse(const struct EmcPose *world, double *joint, const KINEMATICS_INVERSE_FLAGS *iflags,
                      KINEMATICS_FORWARD_FLAGS *fflags) {
    (void)fflags;
    (void)iflags;
    joint[0] = world->tran.x + 0.1 * world->tran.y;
    joint[1] = world->tran.y;
    joint[2] = world->tran.z;
    return world->tran.z < -100; /* nothing reaches below */
}

KINEMATICS_TYPE kinematicsType(void) {
    return KINEMATICS_BOTH;
}

KINS_NOT_SWITCHABLE

int rtapi_app_main(void) {
    comp_id = hal_init("skewkins");
    if (comp_id < 0) {
        return comp_id;
    }
    hal_ready(comp_id);
    return 0;
}

void rtapi_app_exit(void) {
    hal_exit(comp_id);
}
