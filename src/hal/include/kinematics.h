/* SPDX-License-Identifier: GPL-2.0-or-later */
/* Functions that a kinematics module exports. motmod searches for these symbols when it is loaded. */
#ifndef KINEMATICS_H
#define KINEMATICS_H

#include "emcpos.h"
#include "rtapi.h"

typedef enum {
    KINEMATICS_IDENTITY = 1,     /* joints are axes */
    KINEMATICS_FORWARD_ONLY = 2, /* forward kinematics only */
    KINEMATICS_INVERSE_ONLY = 3, /* inverse kinematics only */
    KINEMATICS_BOTH = 4
} KINEMATICS_TYPE;

/* Selects one of several solutions. The module defines the meaning. */
typedef unsigned long int KINEMATICS_FORWARD_FLAGS;
typedef unsigned long int KINEMATICS_INVERSE_FLAGS;

RTAPI_BEGIN_DECLS

/* Returns 0, or nonzero when there is no solution. `world` contains the last pose, from which iterating
 * modules start. */
RTAPI_EXPORT extern int kinematicsForward(const double *joint, struct EmcPose *world,
                                          const KINEMATICS_FORWARD_FLAGS *fflags,
                                          KINEMATICS_INVERSE_FLAGS *iflags);
/* Returns 0, or nonzero when the pose cannot be reached. */
RTAPI_EXPORT extern int kinematicsInverse(const struct EmcPose *world, double *joint,
                                          const KINEMATICS_INVERSE_FLAGS *iflags,
                                          KINEMATICS_FORWARD_FLAGS *fflags);
RTAPI_EXPORT extern int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,
                                       KINEMATICS_INVERSE_FLAGS *iflags);
RTAPI_EXPORT extern KINEMATICS_TYPE kinematicsType(void);

/* For switchable modules: kinematicsSwitchable returns nonzero; kinematicsSwitch returns 0 when it has
 * selected the type. */
RTAPI_EXPORT extern int kinematicsSwitchable(void);
RTAPI_EXPORT extern int kinematicsSwitch(int switchkins_type);

/* ---- parts of modules ----
 * Coordinates are the letters XYZABCUVW; the number of a letter's joint is its position in the text. */

/* Properties of a module for the setup functions below. */
typedef struct kinematics_parms {
    const char *sparm;                /* text of the user */
    const char *kinsname;             /* prefix of messages */
    const char *halprefix;            /* prefix of pin names */
    const char *required_coordinates; /* letters that must be present */
    int allow_duplicates;             /* a letter may have several joints */
    int max_joints;
    int fwd_iterates_mask; /* bit per type: its forward kinematics iterates from the last pose */
    int gui_kinstype;      /* the type that previews show; -1: none */
} kparms;

/* Fills axis_idx_for_jno[0..max_joints-1] with the axis (X 0 ... W 8) of each joint, -1 for joints without an
 * axis. NULL or an empty text means XYZABCUVW. Returns 0, or -1 with a message. */
extern int map_coordinates_to_jnumbers(const char *coordinates, const int max_joints,
                                       const int allow_duplicates, int axis_idx_for_jno[]);
/* Convert between joints and pose by the last mapping. Return 0, or -1 without a mapping. If a letter has
 * several joints, the first one determines the pose. */
extern int mapped_joints_to_position(const int max_joints, const double *joints, EmcPose *pose);
extern int position_to_mapped_joints(const int max_joints, const EmcPose *pos, double *joints);
/* Trivial kinematics (every joint is an axis), as one type of a switchable module. */
extern int identityKinematicsSetup(const int comp_id, const char *coordinates, kparms *ksetup_parms);
extern int identityKinematicsForward(const double *joint, struct EmcPose *world,
                                     const KINEMATICS_FORWARD_FLAGS *fflags,
                                     KINEMATICS_INVERSE_FLAGS *iflags);
extern int identityKinematicsInverse(const struct EmcPose *world, double *joint,
                                     const KINEMATICS_INVERSE_FLAGS *iflags,
                                     KINEMATICS_FORWARD_FLAGS *fflags);

/* A user's own type of a switchable module: type 2 of all modules that have a model and identity. A component
 * that is loaded before the module exports these functions. Setup is called once while the module is loaded,
 * with the letters of its joints. It creates its pins for comp_id and returns 0; with a negative result the
 * module is not loaded. The other two functions are as kinematicsForward and kinematicsInverse. */
RTAPI_EXPORT extern int userkKinematicsSetup(const int comp_id, const char *coordinates,
                                             kparms *ksetup_parms);
RTAPI_EXPORT extern int userkKinematicsForward(const double *joint, struct EmcPose *world,
                                               const KINEMATICS_FORWARD_FLAGS *fflags,
                                               KINEMATICS_INVERSE_FLAGS *iflags);
RTAPI_EXPORT extern int userkKinematicsInverse(const struct EmcPose *world, double *joint,
                                               const KINEMATICS_INVERSE_FLAGS *iflags,
                                               KINEMATICS_FORWARD_FLAGS *fflags);

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
