// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of kinematics.h for one of our models (kinematics/kinematics.hh), or for any class with the
// functions forward and inverse of a model.
#pragma once

#include <algorithm>

#include "hal/include/hal.h"
#include "hal/include/kinematics.h"
#include "hal/include/rtapi_app.h"
#include "kinematics/kinematics.hh"

namespace mw::components {

inline geometry::Pose pose_of(const EmcPose &world) noexcept {
    return {{world.tran.x, world.tran.y, world.tran.z, world.a, world.b, world.c, world.u, world.v, world.w}};
}

/// `world` holds a first guess and the axes that no joint drives. -1 when the model has no solution.
template <class Model>
int model_forward(const Model &model, const double *joint, EmcPose *world) noexcept {
    geometry::Pose pose = pose_of(*world);
    if (!isAnswered(model.forward(joint, pose))) {
        return -1;
    }
    *world = {{pose[0], pose[1], pose[2]}, pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]};
    return 0;
}

template <class Model>
kinematics::Status model_inverse(const Model &model, const EmcPose *world, double *joint) noexcept {
    return model.inverse(pose_of(*world), joint);
}

/// For a module without pins.
inline int no_pins(int) noexcept {
    return 0;
}

/// 0 for a model without sides.
template <class Model>
int model_side(const Model &model, const geometry::Pose &pose) noexcept {
    if constexpr (requires { model.side(pose); }) {
        return model.side(pose);
    } else {
        return 0;
    }
}

/// For linear joints: `slope` has MAX_JOINTS rows of AXIS_COUNT. Returns one bit per linear joint.
template <class Model>
unsigned model_linear(const Model &model, double *slope, unsigned *axes) noexcept {
    *axes = 0;
    if constexpr (requires { model.linear(); }) {
        const kinematics::LinearJoints linear = model.linear();
        for (std::size_t j = 0; j < linear.slope.size(); ++j) {
            std::copy_n(linear.slope[j].c.begin(), geometry::AXIS_COUNT, slope + j * geometry::AXIS_COUNT);
        }
        *axes = linear.axes;
        return linear.joints;
    } else {
        return 0;
    }
}

}  // namespace mw::components

/// Defines kinematicsForward, kinematicsInverse and kinematicsHome for `model`, an object of the module. Also
/// defines mw_kinematics_inverse, which distinguishes a singular pose (0 success, 1 out of reach, 2
/// singular), mw_kinematics_side and mw_kinematics_linear (kinematics/kinematics.hh).
#define MW_KINEMATICS_FUNCTIONS(model)                                                                       \
    extern "C" int kinematicsForward(const double *joint, struct EmcPose *world,                             \
                                     const KINEMATICS_FORWARD_FLAGS *, KINEMATICS_INVERSE_FLAGS *) {         \
        return mw::components::model_forward(model, joint, world);                                           \
    }                                                                                                        \
    extern "C" int kinematicsInverse(const struct EmcPose *world, double *joint,                             \
                                     const KINEMATICS_INVERSE_FLAGS *, KINEMATICS_FORWARD_FLAGS *) {         \
        return isAnswered(mw::components::model_inverse(model, world, joint)) ? 0 : -1;                      \
    }                                                                                                        \
    extern "C" RTAPI_EXPORT int mw_kinematics_inverse(const struct EmcPose *world, double *joint) {          \
        return static_cast<int>(mw::components::model_inverse(model, world, joint));                         \
    }                                                                                                        \
    extern "C" RTAPI_EXPORT int mw_kinematics_side(const struct EmcPose *world) {                            \
        return mw::components::model_side(model, mw::components::pose_of(*world));                           \
    }                                                                                                        \
    extern "C" RTAPI_EXPORT unsigned mw_kinematics_linear(double *slope, unsigned *axes) {                   \
        return mw::components::model_linear(model, slope, axes);                                             \
    }                                                                                                        \
    extern "C" int kinematicsHome(struct EmcPose *world, double *joint, KINEMATICS_FORWARD_FLAGS *fflags,    \
                                  KINEMATICS_INVERSE_FLAGS *iflags) {                                        \
        return kinematicsForward(joint, world, fflags, iflags);                                              \
    }                                                                                                        \
    static_assert(true)

/// As above, for a module with only one type.
#define MW_KINEMATICS(model)                                                                                 \
    MW_KINEMATICS_FUNCTIONS(model);                                                                          \
    extern "C" {                                                                                             \
    KINS_NOT_SWITCHABLE                                                                                      \
    }                                                                                                        \
    static_assert(true)

/// Loading and unloading of module `name`. `declare(comp_id)` creates its pins and returns 0 or a negated
/// errno.
#define MW_KINEMATICS_MAIN(name, declare)                                                                    \
    static int component = -1;                                                                               \
    int rtapi_app_main(void) {                                                                               \
        component = hal_init(name);                                                                          \
        const int status = component < 0 ? component : declare(component);                                   \
        if (status < 0) {                                                                                    \
            hal_exit(component);                                                                             \
            return status;                                                                                   \
        }                                                                                                    \
        return hal_ready(component);                                                                         \
    }                                                                                                        \
    void rtapi_app_exit(void) {                                                                              \
        hal_exit(component);                                                                                 \
    }                                                                                                        \
    static_assert(true)

/// Declares that joints are not axes, and that no call changes any state: the planner may call these
/// functions at the same time as the servo thread.
#define MW_KINEMATICS_PURE MW_KINEMATICS_PURE_IF(true)

/// As MW_KINEMATICS_PURE, for a property that is known only after loading.
#define MW_KINEMATICS_PURE_IF(condition)                                                                     \
    extern "C" KINEMATICS_TYPE kinematicsType(void) {                                                        \
        return KINEMATICS_BOTH;                                                                              \
    }                                                                                                        \
    extern "C" RTAPI_EXPORT int mw_kinematics_is_pure(void) {                                                \
        return (condition) ? 1 : 0;                                                                          \
    }                                                                                                        \
    static_assert(true)
