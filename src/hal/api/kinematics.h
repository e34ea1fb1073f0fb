/* SPDX-License-Identifier: GPL-2.0-or-later */
/* What a kinematics module exports; motmod looks for these symbols when it is loaded. */
#ifndef KINEMATICS_H
#define KINEMATICS_H

#include "emcpos.h"
#include "rtapi.h"

typedef enum {
    KINEMATICS_IDENTITY = 1,     /* joints are axes */
    KINEMATICS_FORWARD_ONLY = 2, /* joints to pose only */
    KINEMATICS_INVERSE_ONLY = 3, /* pose to joints only */
    KINEMATICS_BOTH = 4
} KINEMATICS_TYPE;

/* Which of several solutions was or is to be taken; the module gives them their meaning. */
typedef unsigned long int KINEMATICS_FORWARD_FLAGS;
typedef unsigned long int KINEMATICS_INVERSE_FLAGS;

RTAPI_BEGIN_DECLS

/* 0, or nonzero when there is no solution. `world` holds the last pose, which iterating modules start from.
 */
RTAPI_EXPORT extern int kinematicsForward(const double *joint, struct EmcPose *world,
                                          const KINEMATICS_FORWARD_FLAGS *fflags,
                                          KINEMATICS_INVERSE_FLAGS *iflags);
/* 0, or nonzero when the pose cannot be reached. */
RTAPI_EXPORT extern int kinematicsInverse(const struct EmcPose *world, double *joint,
                                          const KINEMATICS_INVERSE_FLAGS *iflags,
                                          KINEMATICS_FORWARD_FLAGS *fflags);
RTAPI_EXPORT extern int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,
                                       KINEMATICS_INVERSE_FLAGS *iflags);
RTAPI_EXPORT extern KINEMATICS_TYPE kinematicsType(void);

/* Switchable modules: nonzero from kinematicsSwitchable; kinematicsSwitch returns 0 when the type was taken.
 */
RTAPI_EXPORT extern int kinematicsSwitchable(void);
RTAPI_EXPORT extern int kinematicsSwitch(int switchkins_type);

RTAPI_END_DECLS

/* For modules with one type only. */
#define KINS_NOT_SWITCHABLE                                                                                  \
    int kinematicsSwitchable(void) {                                                                         \
        return 0;                                                                                            \
    }                                                                                                        \
    int kinematicsSwitch(int switchkins_type) {                                                              \
        (void)switchkins_type;                                                                               \
        return 0;                                                                                            \
    }                                                                                                        \
    EXPORT_SYMBOL(kinematicsSwitchable);                                                                     \
    EXPORT_SYMBOL(kinematicsSwitch);

#endif
