// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/hal/module_kinematics.hh"

#include <algorithm>
#include <cmath>

#include "hal/include/millwright_ext.h"

namespace mw::motion {

namespace {

EmcPose to_c(const geometry::Pose &p) noexcept {
    return {{p[0], p[1], p[2]}, p[3], p[4], p[5], p[6], p[7], p[8]};
}

geometry::Pose from_c(const EmcPose &p) noexcept {
    return {{p.tran.x, p.tran.y, p.tran.z, p.a, p.b, p.c, p.u, p.v, p.w}};
}

template <class Function>
Function find_function(const char *name) noexcept {
    return reinterpret_cast<Function>(mw_ext_find_symbol(name));
}

}  // namespace

const char *ModuleKinematics::find(int num_joints) noexcept {
    forward_ = find_function<decltype(forward_)>("kinematicsForward");
    inverse_ = find_function<decltype(inverse_)>("kinematicsInverse");
    inverse_with_status_ = find_function<decltype(inverse_with_status_)>("mw_kinematics_inverse");
    side_ = find_function<decltype(side_)>("mw_kinematics_side");
    linear_ = find_function<decltype(linear_)>("mw_kinematics_linear");
    const auto type = find_function<decltype(&kinematicsType)>("kinematicsType");
    num_joints_ = num_joints;
    if (forward_ == nullptr) {
        return "kinematicsForward";
    }
    if (inverse_ == nullptr) {
        return "kinematicsInverse";
    }
    if (type == nullptr) {
        return "kinematicsType";
    }
    switch (type()) {
    case KINEMATICS_FORWARD_ONLY: kind_ = kinematics::Kind::FORWARD_ONLY; break;
    case KINEMATICS_INVERSE_ONLY: kind_ = kinematics::Kind::INVERSE_ONLY; break;
    case KINEMATICS_BOTH: kind_ = kinematics::Kind::BOTH; break;
    case KINEMATICS_IDENTITY: kind_ = kinematics::Kind::IDENTITY; break;
    }
    const auto is_pure = find_function<int (*)()>("mw_kinematics_is_pure");
    isPure_ = is_pure != nullptr && is_pure() != 0;
    const auto is_switchable = find_function<decltype(&kinematicsSwitchable)>("kinematicsSwitchable");
    if (is_switchable != nullptr && is_switchable() != 0) {
        types_.switch_it = find_function<decltype(&kinematicsSwitch)>("kinematicsSwitch");
    }
    // Only a module that declares the identity has joints that are axes, because crossed axes look the same
    // when single joints are tested.
    const auto is_identity = find_function<int (*)()>("mw_kinematics_is_identity");
    const bool isSaid = kind_ == kinematics::Kind::IDENTITY || (is_identity != nullptr && is_identity() != 0);
    if (isSaid) {
        find_axes(num_joints);
    }
    return nullptr;
}

int ModuleKinematics::hold(int comp_id) const noexcept {
    return mw_ext_use_module("kinematicsInverse", comp_id);
}

/// Finds the axis of each joint from the inverse of unit poses. Values other than 0 and 1 are not an
/// identity, even if the module declares one.
void ModuleKinematics::find_axes(int num_joints) noexcept {
    double zero[MAX_JOINTS];
    for (double &x : zero) {
        x = NAN;  // values that the module does not set remain NaN
    }
    EmcPose origin = to_c({});
    isIdentity_ = inverse_(&origin, zero, &inverse_flags_, &forward_flags_) == 0;
    map_.axis_of_joint.fill(-1);
    map_.num_joints = 0;
    for (int axis = 0; axis < geometry::AXIS_COUNT && isIdentity_; ++axis) {
        for (const double length : {1.0, -37.25}) {
            geometry::Pose unit;
            unit[axis] = length;
            const EmcPose pose = to_c(unit);
            double joints[MAX_JOINTS];
            for (double &x : joints) {
                x = NAN;
            }
            isIdentity_ = isIdentity_ && inverse_(&pose, joints, &inverse_flags_, &forward_flags_) == 0;
            for (int j = 0; j < num_joints && isIdentity_; ++j) {
                const auto n = static_cast<std::size_t>(j);
                const bool isSet = !std::isnan(joints[j]) && zero[j] == 0.0;
                if (isSet && joints[j] == length) {
                    map_.axis_of_joint[n] = static_cast<std::int8_t>(axis);
                    map_.num_joints = j + 1 > map_.num_joints ? j + 1 : map_.num_joints;
                } else if (!std::isnan(joints[j])) {
                    isIdentity_ = joints[j] == 0.0 && zero[j] == 0.0;
                }
            }
        }
    }
    for (int j = 0; j < map_.num_joints; ++j) {
        isIdentity_ = isIdentity_ && map_.axis_of_joint[static_cast<std::size_t>(j)] >= 0;
    }
    isIdentity_ = isIdentity_ && map_.num_joints > 0;
}

kinematics::Status ModuleKinematics::forward(const double *joints, kinematics::Pose &pose) const noexcept {
    EmcPose world = to_c(pose);
    const bool isFound = forward_(joints, &world, &forward_flags_, &inverse_flags_) == 0;
    const geometry::Pose found = from_c(world);
    bool areNumbers = isFound;
#pragma GCC unroll 9
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        areNumbers &= std::isfinite(found[i]);
    }
    if (!areNumbers) {
        return kinematics::Status::UNREACHABLE;
    }
    pose = found;
    return kinematics::Status::OK;
}

kinematics::Status ModuleKinematics::inverse(const kinematics::Pose &pose, double *joints) const noexcept {
    double found[MAX_JOINTS] = {};  // a module may set more joints than the machine has
    for (int j = 0; j < num_joints_; ++j) {
        found[j] = joints[j];
    }
    const EmcPose world = to_c(pose);
    kinematics::Status status = kinematics::Status::OK;
    if (inverse_with_status_ != nullptr) {
        status = static_cast<kinematics::Status>(inverse_with_status_(&world, found));
    } else if (inverse_(&world, found, &inverse_flags_, &forward_flags_) != 0) {
        status = kinematics::Status::UNREACHABLE;
    }
    bool isFound = isAnswered(status);
    for (int j = 0; j < num_joints_; ++j) {
        isFound = isFound && std::isfinite(found[j]);
    }
    for (int j = 0; j < num_joints_ && isFound; ++j) {
        joints[j] = found[j];
    }
    return isFound ? status : kinematics::Status::UNREACHABLE;
}

int ModuleKinematics::side(const kinematics::Pose &pose) const noexcept {
    const EmcPose world = to_c(pose);
    return side_ != nullptr ? side_(&world) : 0;
}

kinematics::LinearJoints ModuleKinematics::linear() const noexcept {
    kinematics::LinearJoints out;
    if (linear_ != nullptr && isPure_ && !isIdentity_) {
        double slope[MAX_JOINTS * geometry::AXIS_COUNT] = {};
        unsigned axes = 0;
        out.joints = linear_(slope, &axes);
        out.axes = axes;
        for (std::size_t j = 0; j < out.slope.size(); ++j) {
            std::copy_n(slope + j * geometry::AXIS_COUNT, geometry::AXIS_COUNT, out.slope[j].c.begin());
        }
    }
    return out;
}

}  // namespace mw::motion
