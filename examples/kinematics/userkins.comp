// SPDX-License-Identifier: GPL-2.0-or-later
component userkins "Template for kinematics of one's own";
description """
Three joints that are the axes X, Y and Z, where Y may lean: for each unit of Y the machine goes userkins.lean units of X.

Copy this file, name it and its component anew, write the two functions, then: halcompile --install NAME.comp and
[KINS]KINEMATICS = NAME. What a kinematics may assume stands in docs/developer/extending/kinematics.md.
""";
pin out s32 fpin = 0 "counts the runs of fdemo: a component has a pin of its own";
function fdemo;
option extra_setup yes;
license "GPL";
author "Millwright";
;;
#include <rtapi_math.h>
#include <hal.h>
#include <kinematics.h>

/* Pins of the kinematics live in HAL memory. */
typedef struct {
    hal_float_t *lean;
} kinematics_pins;
static kinematics_pins *pins;

EXTRA_SETUP() {
    pins = hal_malloc(sizeof(*pins));
    if (pins == NULL) {
        return -ENOMEM;
    }
    return hal_pin_float_newf(HAL_IN, &pins->lean, comp_id, "userkins.lean");
}

FUNCTION(fdemo) {
    fpin = (fpin + 1) % 1000;
}

/* Where the joints are, as a pose: 0. Nothing may wait, allocate or print: this runs in the servo thread. */
int kinematicsForward(const double *joint, EmcPose *pose, const KINEMATICS_FORWARD_FLAGS *fflags,
                      KINEMATICS_INVERSE_FLAGS *iflags) {
    (void)fflags;
    (void)iflags;
    pose->tran.x = joint[0] - *pins->lean * joint[1];
    pose->tran.y = joint[1];
    pose->tran.z = joint[2];
    pose->a = pose->b = pose->c = 0;
    pose->u = pose->v = pose->w = 0;
    return 0;
}

/* The joints of a pose: 0, or nonzero when it cannot be reached. */
int kinematicsInverse(const EmcPose *pose, double *joint, const KINEMATICS_INVERSE_FLAGS *iflags,
                      KINEMATICS_FORWARD_FLAGS *fflags) {
    (void)fflags;
    (void)iflags;
    joint[0] = pose->tran.x + *pins->lean * pose->tran.y;
    joint[1] = pose->tran.y;
    joint[2] = pose->tran.z;
    return 0;
}

/* KINEMATICS_IDENTITY where each joint is an axis, KINEMATICS_BOTH where it is not. */
KINEMATICS_TYPE kinematicsType(void) {
    return KINEMATICS_BOTH;
}

/* Nothing is remembered from one call to the next, so the planner may ask as well, and keeps the limits of the joints. */
RTAPI_EXPORT int mw_kinematics_is_pure(void) {
    return 1;
}

KINS_NOT_SWITCHABLE
EXPORT_SYMBOL(kinematicsType);
EXPORT_SYMBOL(kinematicsForward);
EXPORT_SYMBOL(kinematicsInverse);
EXPORT_SYMBOL(mw_kinematics_is_pure);
