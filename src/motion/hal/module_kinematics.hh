// SPDX-License-Identifier: GPL-2.0-or-later
// Kinematics of a loaded module, of Millwright or another source, through the C functions of kinematics.h.
#pragma once

#include "hal/include/kinematics.h"
#include "kinematics/kinematics.hh"

namespace mw::motion {

/// The kinematics types of a module, switched by the module's function.
class ModuleTypes final : public kinematics::TypeSwitch {
  public:
    decltype(&kinematicsSwitch) switch_it = nullptr;

    bool switch_to(int type) noexcept override { return switch_it(type) == 0; }
};

class ModuleKinematics final : public kinematics::Kinematics {
  public:
    /// Finds the functions in the loaded modules. Returns null, or the name of a missing one. [while loading]
    const char *find(int num_joints) noexcept;
    /// Keeps the module loaded as long as component `comp_id`. Returns 0 or a negated errno. [while loading]
    int hold(int comp_id) const noexcept;

    kinematics::Kind kind() const noexcept override { return kind_; }
    [[gnu::hot]] kinematics::Status forward(const double *joints,
                                            kinematics::Pose &pose) const noexcept override;
    [[gnu::hot]] kinematics::Status inverse(const kinematics::Pose &pose,
                                            double *joints) const noexcept override;
    const kinematics::IdentityMap *identity() const noexcept override {
        return isIdentity_ ? &map_ : nullptr;
    }
    int side(const kinematics::Pose &pose) const noexcept override;
    kinematics::LinearJoints linear() const noexcept override;
    kinematics::TypeSwitch *type_switch() const noexcept override {
        return types_.switch_it != nullptr ? &types_ : nullptr;
    }
    /// A module declares this by exporting mw_kinematics_is_pure.
    bool isShareable() const noexcept override { return isIdentity_ || isPure_; }

  private:
    void find_axes(int num_joints) noexcept;

    decltype(&kinematicsForward) forward_ = nullptr;
    decltype(&kinematicsInverse) inverse_ = nullptr;
    int (*inverse_with_status_)(const EmcPose *,
                                double *) = nullptr;      ///< only Millwright's modules: can return SINGULAR
    int (*side_)(const EmcPose *) = nullptr;              ///< the same
    unsigned (*linear_)(double *, unsigned *) = nullptr;  ///< the same
    mutable ModuleTypes types_;
    int num_joints_ = MAX_JOINTS;
    kinematics::Kind kind_ = kinematics::Kind::IDENTITY;
    bool isIdentity_ = false, isPure_ = false;
    kinematics::IdentityMap map_;
    mutable KINEMATICS_FORWARD_FLAGS forward_flags_ = 0;
    mutable KINEMATICS_INVERSE_FLAGS inverse_flags_ = 0;
};

}  // namespace mw::motion
