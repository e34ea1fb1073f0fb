// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of machines whose joints are axes. coordinates=XYYZ: joint n drives the n-th letter.
// kinstype=1 identity (default), both: joints and axes differ for operators (gantries), f: forward only, i:
// inverse only.
#include "hal/api/hal.h"
#include "hal/api/kinematics.h"
#include "hal/api/rtapi_app.h"
#include "kins/trivial.hh"

using mw::geom::Pose;

static char *coordinates;
RTAPI_MP_STRING(coordinates, "axis letters in the order of the joints");
static char *kinstype;
RTAPI_MP_STRING(kinstype, "1 identity, b both, f forward only, i inverse only");

static mw::kins::Trivial model;
static KINEMATICS_TYPE type = KINEMATICS_IDENTITY;
static int component = -1;

extern "C" int kinematicsForward(const double *joint, struct EmcPose *world, const KINEMATICS_FORWARD_FLAGS *,
                                 KINEMATICS_INVERSE_FLAGS *) {
    Pose pose{{world->tran.x, world->tran.y, world->tran.z, world->a, world->b, world->c, world->u, world->v,
               world->w}};
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
    return type;
}

extern "C" {
KINS_NOT_SWITCHABLE
}

int rtapi_app_main(void) {
    const char *letters = coordinates != nullptr && coordinates[0] != '\0' ? coordinates : "XYZABCUVW";
    if (!model.configure(letters)) {
        rtapi_print_msg(RTAPI_MSG_ERR,
                        "trivkins: coordinates=%s: expected up to 16 of the letters XYZABCUVW\n", letters);
        return -22;  // EINVAL
    }
    switch (kinstype != nullptr ? kinstype[0] : '1') {
    case 'b':
    case 'B': type = KINEMATICS_BOTH; break;
    case 'f':
    case 'F': type = KINEMATICS_FORWARD_ONLY; break;
    case 'i':
    case 'I': type = KINEMATICS_INVERSE_ONLY; break;
    case '1':
    case '\0': type = KINEMATICS_IDENTITY; break;
    default:
        rtapi_print_msg(RTAPI_MSG_ERR, "trivkins: kinstype=%s: expected 1, both, f or i\n", kinstype);
        return -22;  // EINVAL
    }
    component = hal_init("trivkins");
    if (component < 0) {
        return component;
    }
    return hal_ready(component);
}

void rtapi_app_exit(void) {
    hal_exit(component);
}
