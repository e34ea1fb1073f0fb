// SPDX-License-Identifier: GPL-2.0-or-later
// The type of a switchable module that is implemented by a component of the user. This component is loaded
// before the module and exports the three functions userkKinematics* of kinematics.h. Without it, joints are
// axes.
#pragma once

#include "components/motion/kinematics_module.hh"
#include "hal/include/millwright_ext.h"
#include "kinematics/trivial.hh"

namespace mw::components {

/// One of the kinematics types of a module.
class TypePart {
  public:
    virtual kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept = 0;
    virtual kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept = 0;
    virtual int side(const kinematics::Pose &pose) const noexcept = 0;
    /// Receives the joint positions while another type is active. [servo]
    virtual void watch(const double *) const noexcept {}

  protected:
    ~TypePart() = default;
};

class UserType final : public TypePart {
  public:
    explicit UserType(const kinematics::Trivial &letters) noexcept : letters_(letters) {}
    UserType(const UserType &) = delete;
    UserType &operator=(const UserType &) = delete;

    /// Finds the functions and calls the setup. Returns 0, the result of the user's setup when it is
    /// negative, or a negated errno; each error has a message. [while loading]
    int declare(int comp_id, const char *module, const char *letters, const char *sparm) noexcept {
        setup_ = find<decltype(setup_)>("userkKinematicsSetup");
        forward_ = find<decltype(forward_)>("userkKinematicsForward");
        inverse_ = find<decltype(inverse_)>("userkKinematicsInverse");
        if (setup_ == nullptr && forward_ == nullptr && inverse_ == nullptr) {
            return 0;
        }
        if (setup_ == nullptr || forward_ == nullptr || inverse_ == nullptr) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "%s: a user's type needs userkKinematicsSetup, userkKinematicsForward and "
                            "userkKinematicsInverse, and one of them is missing\n",
                            module);
            return -EINVAL;
        }
        kparms parameters = {};
        parameters.sparm = sparm;
        parameters.kinsname = module;
        parameters.halprefix = module;
        parameters.required_coordinates = "";
        parameters.allow_duplicates = 1;
        parameters.max_joints = letters_.identity()->num_joints;
        parameters.gui_kinstype = -1;
        const int status = setup_(comp_id, letters, &parameters);
        if (status < 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "%s: the user's type did not set itself up (%d)\n", module,
                            status);
            return status;
        }
        const auto is_pure = find<int (*)()>("mw_userk_is_pure");
        pure_ = is_pure != nullptr && is_pure() != 0;
        return mw_ext_use_module("userkKinematicsInverse", comp_id);
    }
    bool isThere() const noexcept { return forward_ != nullptr; }
    bool isPure() const noexcept { return !isThere() || pure_; }

    kinematics::Status forward(const double *joints, kinematics::Pose &pose) const noexcept override {
        if (forward_ == nullptr) {
            return letters_.forward(joints, pose);
        }
        EmcPose world = {{pose[0], pose[1], pose[2]}, pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]};
        if (forward_(joints, &world, &forward_flags_, &inverse_flags_) != 0) {
            return kinematics::Status::UNREACHABLE;
        }
        pose = pose_of(world);
        return kinematics::Status::OK;
    }
    kinematics::Status inverse(const kinematics::Pose &pose, double *joints) const noexcept override {
        if (inverse_ == nullptr) {
            return letters_.inverse(pose, joints);
        }
        const EmcPose world = {
            {pose[0], pose[1], pose[2]}, pose[3], pose[4], pose[5], pose[6], pose[7], pose[8]};
        const bool found = inverse_(&world, joints, &inverse_flags_, &forward_flags_) == 0;
        return found ? kinematics::Status::OK : kinematics::Status::UNREACHABLE;
    }
    int side(const kinematics::Pose &) const noexcept override { return 0; }

  private:
    template <class Function>
    static Function find(const char *name) noexcept {
        return reinterpret_cast<Function>(mw_ext_find_symbol(name));
    }

    const kinematics::Trivial &letters_;
    decltype(&userkKinematicsSetup) setup_ = nullptr;
    decltype(&userkKinematicsForward) forward_ = nullptr;
    decltype(&userkKinematicsInverse) inverse_ = nullptr;
    // For a component whose functions keep state in these flags; such a module is called only by the servo
    // thread.
    mutable KINEMATICS_FORWARD_FLAGS forward_flags_ = 0;
    mutable KINEMATICS_INVERSE_FLAGS inverse_flags_ = 0;
    bool pure_ = false;
};

}  // namespace mw::components
