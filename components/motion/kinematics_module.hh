// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of kinematics.h over one of our models (kins/kinematics.hh).
#pragma once

#include "hal/api/hal.h"
#include "hal/api/kinematics.h"
#include "hal/api/rtapi_app.h"
#include "kins/kinematics.hh"

namespace mw::components {

/// `world` holds a guess and what no joint drives. -1 when the model has no answer.
inline int model_forward(const kins::Kinematics &model, const double *joint, EmcPose *world) noexcept {
    geom::Pose pose{{world->tran.x, world->tran.y, world->tran.z, world->a, world->b, world->c, world->u,
                     world->v, world->w}};
    if (model.forward(joint, pose) != kins::Status::OK) {
        return -1;
    }
    *world = {{pose[0], pose[1], pose[2]}, pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]};
    return 0;
}

inline int model_inverse(const kins::Kinematics &model, const EmcPose *world, double *joint) noexcept {
    const geom::Pose pose{{world->tran.x, world->tran.y, world->tran.z, world->a, world->b, world->c,
                           world->u, world->v, world->w}};
    return model.inverse(pose, joint) == kins::Status::OK ? 0 : -1;
}

}  // namespace mw::components

/// Defines kinematicsForward, kinematicsInverse and kinematicsHome over `model`, an object of the module.
#define MW_KINEMATICS(model)                                                                                 \
    extern "C" int kinematicsForward(const double *joint, struct EmcPose *world,                             \
                                     const KINEMATICS_FORWARD_FLAGS *, KINEMATICS_INVERSE_FLAGS *) {         \
        return mw::components::model_forward(model, joint, world);                                           \
    }                                                                                                        \
    extern "C" int kinematicsInverse(const struct EmcPose *world, double *joint,                             \
                                     const KINEMATICS_INVERSE_FLAGS *, KINEMATICS_FORWARD_FLAGS *) {         \
        return mw::components::model_inverse(model, world, joint);                                           \
    }                                                                                                        \
    extern "C" int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,    \
                                  KINEMATICS_INVERSE_FLAGS *iflags) {                                        \
        return kinematicsForward(joint, world, fflags, iflags);                                              \
    }                                                                                                        \
    extern "C" {                                                                                             \
    KINS_NOT_SWITCHABLE                                                                                      \
    }                                                                                                        \
    static_assert(true)
