// SPDX-License-Identifier: GPL-2.0-or-later
// Forward and inverse kinematics. Parameters are in the object, not in static variables. Every call returns a
// status and never aborts.
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
    /// A solution exists, but several solutions coincide or there are infinitely many. The machine may be
    /// stopped at this pose and keeps its position, but no path may pass through it.
    SINGULAR,
};
/// True when there is a solution.
constexpr bool isAnswered(Status status) noexcept {
    return status != Status::UNREACHABLE;
}
enum class Kind : std::uint8_t { IDENTITY, FORWARD_ONLY, INVERSE_ONLY, BOTH };

/// The axis that each joint drives, for machines whose joints are axes; -1: no axis.
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

/// Joint n drives axis n.
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
    /// several solutions the one on the same side is chosen. Coordinates that no joint drives are not
    /// changed.
    virtual Status forward(const double *joints, Pose &pose) const noexcept = 0;
    /// The joint positions of this pose. `joints` holds the last ones: of several solutions (elbow up or
    /// down) the one on the same side is chosen, and for an angle the nearest revolution.
    virtual Status inverse(const Pose &pose, double *joints) const noexcept = 0;
    /// Not null when each joint is one axis: limits are then combined without a Jacobian.
    virtual const IdentityMap *identity() const noexcept { return nullptr; }

    /// The linear joints and their slopes, with the current parameters. Empty when joints are axes.
    virtual LinearJoints linear() const noexcept { return {}; }

    /// Side of a pose. Poses of different sides are separated by singular poses: above and below the motors,
    /// or the assembly modes of a platform's struts. 0: the model has only one side, or the side depends on
    /// the joints.
    virtual int side(const Pose &) const noexcept { return 0; }

    /// Null when there is only one type.
    virtual TypeSwitch *type_switch() const noexcept { return nullptr; }

    /// False when calls share hidden state. Then only the servo thread may call them.
    virtual bool isShareable() const noexcept { return true; }

  protected:
    ~Kinematics() = default;
};

}  // namespace mw::kinematics
