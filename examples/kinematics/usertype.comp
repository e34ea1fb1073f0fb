// SPDX-License-Identifier: GPL-2.0-or-later
component usertype "Template for a user's own type of a switchable kinematics";
description """
What the modules of kinematics that can be switched have as type 2: the machine mirrored in Y and moved by usertype.shift
along X, as a second fixture may want it.

Copy this file, name its component anew, write the functions, then: halcompile --install NAME.comp and loadrt NAME in a HAL
file before the kinematics is loaded. Programs switch by M68 and M66 (docs/developer/extending/kinematics.md).
""";
pin out s32 fpin = 0 "a component has a pin of its own";
option singleton yes;
license "GPL";
author "Millwright";
;;
#include <rtapi_math.h>
#include <hal.h>
#include <kinematics.h>

/* Pins of the kinematics live in HAL memory, and belong to the module that has this type. */
typedef struct {
    hal_float_t *shift;
} type_pins;
static type_pins *pins;

/* Once, while the switchable module is loaded: 0, or negative, upon which it is not loaded. */
int userkKinematicsSetup(const int comp_id, const char *coordinates, kparms *ksetup_parms) {
    (void)coordinates;
    (void)ksetup_parms;
    pins = hal_malloc(sizeof(*pins));
    if (pins == NULL) {
        return -ENOMEM;
    }
    return hal_pin_float_newf(HAL_IN, &pins->shift, comp_id, "usertype.shift");
}

/* Where the joints are, as a pose: 0. Nothing may wait, allocate or print: this runs in the servo thread. */
int userkKinematicsForward(const double *joint, EmcPose *pose, const KINEMATICS_FORWARD_FLAGS *fflags,
                           KINEMATICS_INVERSE_FLAGS *iflags) {
    (void)fflags;
    (void)iflags;
    pose->tran.x = joint[0] - *pins->shift;
    pose->tran.y = -joint[1];
    pose->tran.z = joint[2];
    pose->a = joint[3];
    pose->c = joint[4];
    return 0;
}

/* The joints of a pose: 0, or nonzero when it cannot be reached. */
int userkKinematicsInverse(const EmcPose *pose, double *joint, const KINEMATICS_INVERSE_FLAGS *iflags,
                           KINEMATICS_FORWARD_FLAGS *fflags) {
    (void)fflags;
    (void)iflags;
    joint[0] = pose->tran.x + *pins->shift;
    joint[1] = -pose->tran.y;
    joint[2] = pose->tran.z;
    joint[3] = pose->a;
    joint[4] = pose->c;
    return 0;
}

/* Nothing is remembered from one call to the next, so the planner may ask as well, and keeps the limits of the joints. */
RTAPI_EXPORT int mw_userk_is_pure(void) {
    return 1;
}

EXPORT_SYMBOL(userkKinematicsSetup);
EXPORT_SYMBOL(userkKinematicsForward);
EXPORT_SYMBOL(userkKinematicsInverse);
EXPORT_SYMBOL(mw_userk_is_pure);
