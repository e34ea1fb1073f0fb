// SPDX-License-Identifier: GPL-2.0-or-later
// Joints to pose and back. Pure: parameters in the object, no statics; every call answers, none aborts.
#pragma once

#include <array>
#include <cstdint>

#include "base/geometry/pose.hh"
#include "base/limits.hh"

namespace mw::kinematics {

using geometry::Pose;

enum class Status : std::uint8_t {
    OK,
    UNREACHABLE,  ///< no answer; what was to be filled is as it was
    /// Answered, but solutions meet here or there are infinitely many: a machine may stand here, and what it
    /// stands at is kept, yet no path leads through.
    SINGULAR,
};
/// True when there is an answer.
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

/// Joints that go in proportion to axes, everywhere alike: joint = slope . pose.
struct LinearJoints {
    std::uint32_t joints = 0;              ///< bit per joint that does
    std::uint32_t axes = 0;                ///< bit per axis that moves no joints but these
    std::array<Pose, MAX_JOINTS> slope{};  ///< of each of them, by axis

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

/// Of kinematics with several types, such as a tilting table and the same machine with joints for axes.
class TypeSwitch {
  public:
    /// False when there is no such type: then the one in force stays. While nothing moves. [servo thread]
    virtual bool switch_to(int type) noexcept = 0;

  protected:
    ~TypeSwitch() = default;
};

/// `joints` has MAX_JOINTS elements [machine units or degrees]. Realtime-safe.
class Kinematics {
  public:
    virtual Kind kind() const noexcept = 0;
    /// The pose of these joint positions. `pose` holds the last pose: iterating models begin there, and where
    /// there are several poses the one of its side is taken. What no joint drives stays as it is.
    virtual Status forward(const double *joints, Pose &pose) const noexcept = 0;
    /// The joint positions of this pose. `joints` holds the last ones: of several solutions (elbow up or
    /// down) theirs is taken, and of an angle the turn nearest to theirs.
    virtual Status inverse(const Pose &pose, double *joints) const noexcept = 0;
    /// Not null when each joint is one axis: limits then fold together without any Jacobian.
    virtual const IdentityMap *identity() const noexcept { return nullptr; }

    /// Which joints are linear, and how; with parameters as they are now. None where joints are axes.
    virtual LinearJoints linear() const noexcept { return {}; }

    /// Of poses that meet only at singular ones, which a pose is of: above and below the motors, either way
    /// to put the struts of a platform together; a path from one to another leads through a singular pose. 0:
    /// the model has one only, or the side is that of the joints.
    virtual int side(const Pose &) const noexcept { return 0; }

    /// Null where there is one type only.
    virtual TypeSwitch *type_switch() const noexcept { return nullptr; }

    /// False when calls share hidden state, so that only the servo thread may make them.
    virtual bool isShareable() const noexcept { return true; }

  protected:
    ~Kinematics() = default;
};

}  // namespace mw::kinematics
