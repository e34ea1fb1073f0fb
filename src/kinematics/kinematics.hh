// SPDX-License-Identifier: GPL-2.0-or-later
// Forward and inverse kinematics. Pure: parameters are in the object, no statics; every call returns a
// status, none aborts.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/limits.hh"

namespace mw::kinematics {

using geometry::Pose;

enum class Status : std::uint8_t {
    OK,
    UNREACHABLE,  ///< no solution; outputs are unchanged
    /// A solution exists, but several meet here or there are infinitely many. The machine may be stopped here
    /// and its position is kept, but no path may pass through.
    SINGULAR,
};
/// True when there is a solution.
constexpr bool isAnswered(Status status) noexcept {
    return status != Status::UNREACHABLE;
}
enum class Kind : std::uint8_t { IDENTITY, FORWARD_ONLY, INVERSE_ONLY, BOTH };

/// Which axis each joint drives, for machines whose joints are axes; -1 drives none.
struct IdentityMap {
    std::array<std::int8_t, MAX_JOINTS> axis_of_joint{};
    int num_joints = 0;

    /// True when a joint drives this axis.
    constexpr bool has(int axis) const noexcept {
        for (int j = 0; j < num_joints; ++j) {
            if (axis_of_joint[static_cast<std::size_t>(j)] == axis) {
                return true;
            }
        }
        return false;
    }
};

/// Joints that are linear in the axes at all poses: joint = slope . pose.
struct LinearJoints {
    std::uint32_t joints = 0;              ///< bit per linear joint
    std::uint32_t axes = 0;                ///< bit per axis that moves only these joints
    std::array<Pose, MAX_JOINTS> slope{};  ///< slope of each joint, by axis

    constexpr bool moves(int joint, int axis) const noexcept {
        return (joints >> joint & 1U) != 0 && slope[static_cast<std::size_t>(joint)][axis] != 0;
    }
    constexpr bool operator==(const LinearJoints &) const noexcept = default;
};

/// Joint n is axis n.
constexpr LinearJoints joints_like_axes() noexcept {
    LinearJoints out;
    out.joints = out.axes = (1U << geometry::AXIS_COUNT) - 1U;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        out.slope[static_cast<std::size_t>(i)][i] = 1;
    }
    return out;
}

/// For kinematics with several types, such as a tilting table and the same machine with trivial kinematics.
class TypeSwitch {
  public:
    /// Selects a type; false, and no change, when there is no such type. Only while nothing moves. [servo
    /// thread]
    virtual bool switch_to(int type) noexcept = 0;

  protected:
    ~TypeSwitch() = default;
};

/// `joints` has MAX_JOINTS elements [machine units or degrees]. Realtime-safe.
class Kinematics {
  public:
    virtual Kind kind() const noexcept = 0;
    /// The pose of these joint positions. `pose` holds the last pose: iterating models start there, and of
    /// several poses the one on its side is chosen. Coordinates that no joint drives are not changed.
    virtual Status forward(const double *joints, Pose &pose) const noexcept = 0;
    /// The joint positions of this pose. `joints` holds the last ones: of several solutions (elbow up or
    /// down) the one on their side is chosen, and for an angle the nearest revolution.
    virtual Status inverse(const Pose &pose, double *joints) const noexcept = 0;
    /// Not null when each joint is one axis: limits are then combined without a Jacobian.
    virtual const IdentityMap *identity() const noexcept { return nullptr; }

    /// The linear joints and their slopes, with the current parameters. None when joints are axes.
    virtual LinearJoints linear() const noexcept { return {}; }

    /// Side of a pose. Poses of different sides are separated by singular poses: above and below the motors,
    /// or the assembly modes of a platform's struts. 0: the model has one side only, or the side depends on
    /// the joints.
    virtual int side(const Pose &) const noexcept { return 0; }

    /// Null when there is one type only.
    virtual TypeSwitch *type_switch() const noexcept { return nullptr; }

    /// False when calls share hidden state; then only the servo thread may call.
    virtual bool isShareable() const noexcept { return true; }

  protected:
    ~Kinematics() = default;
};

}  // namespace mw::kinematics
