// SPDX-License-Identifier: GPL-2.0-or-later
// Checks that the machine can reach every point of a move: soft limits of axes, limits of joints, kinematics.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/seqlock.hh"
#include "kinematics/kinematics.hh"
#include "motion/interface/command.hh"
#include "motion/interface/limits.hh"
#include "motion/planner/path_link.hh"
#include "trajectory/path/joint_map.hh"
#include "trajectory/path/primitive.hh"

namespace mw::motion {

/// The inverse of pure kinematics for the planner. Among several solutions it returns the one with the
/// configuration of its last joint positions.
class KinematicsMap final : public trajectory::JointMap {
  public:
    using Joints = std::array<double, MAX_JOINTS>;

    explicit KinematicsMap(const kinematics::Kinematics &kinematics) noexcept : kinematics_(kinematics) {}
    void stand_at(const Joints &joints, int side) noexcept {
        near_ = joints;
        side_ = side;
    }
    /// Finds the joints at a pose, nearest to those in `joints`. Also returns SINGULAR for a pose that can be
    /// reached only through a singular one.
    kinematics::Status find(const geometry::Pose &pose, double *joints) const noexcept {
        const bool isBeyond = side_ != 0 && kinematics_.side(pose) != side_;
        const kinematics::Status status = kinematics_.inverse(pose, joints);
        return isBeyond && isAnswered(status) ? kinematics::Status::SINGULAR : status;
    }
    bool joints_at(const geometry::Pose &pose, double *joints) const noexcept override {
        std::copy(near_.begin(), near_.end(), joints);
        const bool isFound = find(pose, joints) == kinematics::Status::OK;
        if (isFound) {
            std::copy_n(joints, near_.size(), near_.begin());
        }
        return isFound;
    }

  private:
    const kinematics::Kinematics &kinematics_;
    mutable Joints near_{};  // [planner thread]
    int side_ = 0;
};

/// Remaining travel of a line to the nearest limit.
struct TravelToLimit {
    double way = trajectory::UNLIMITED;  ///< [machine units, degrees]
    int axis = -1, joint = -1;           ///< axis or joint of the limit; joint MAX_JOINTS: the kinematics
};

/// Reason why a move is not possible.
struct Refusal {
    Reason reason = Reason::NONE;
    std::int16_t index = -1;  ///< axis or joint of the reason
};

/// Knows the joint positions at the end of the last accepted move: they select the solution of the
/// kinematics for the next one. [planner thread]
class ReachCheck {
  public:
    using Joints = KinematicsMap::Joints;

    ReachCheck(const kinematics::Kinematics &kinematics, int num_joints) noexcept
        : kinematics_(kinematics), map_(kinematics), num_joints_(num_joints) {}

    /// Reads the limits, and the joint positions if these have changed without a path. False if the limits
    /// are being written.
    bool follow(const Seqlock<PathLimits> &limits) noexcept;
    const PathLimits &limits() const noexcept { return limits_; }
    /// True if the planner must check joints: they are no axes, and it may call the kinematics.
    bool isMapped() const noexcept { return kinematics_.identity() == nullptr && kinematics_.isShareable(); }
    KinematicsMap &map() noexcept { return map_; }

    /// Range of the axes on a move, and of joints that external offsets move as well; 0 for other joints.
    TravelRange extent(const trajectory::Primitive &p) const noexcept;
    /// `move`: the extent of `p`; `room`: the available travel. `indexer`: joint whose lock opens for this
    /// move, -1: none. Accepts a move from outside back inside if its end is inside.
    Refusal check(const trajectory::Primitive &p, const TravelRange &move, const TravelRange &room,
                  int indexer) noexcept;

    const Joints &end_joints() const noexcept { return end_joints_; }
    /// For a move that returns to its start.
    void set_end_joints(const Joints &joints) noexcept { end_joints_ = joints; }

    /// Remaining travel of a line from its end, or from its start with the sense -1. The joints are at
    /// `joints` there; `turn`: travel per spindle revolution.
    TravelToLimit travel_past(const trajectory::Primitive &line, double sense, const Joints &joints,
                              double turn) const noexcept;

  private:
    /// Joint positions at a point of a path.
    struct PathSample {
        double at = 0;
        Joints joints{};
    };
    Refusal check_axes(const trajectory::Primitive &p, const PoseRange &move, const PoseRange &room,
                       int indexer) const noexcept;
    Refusal check_joints(const trajectory::Primitive &p, const JointRange &room) noexcept;
    Refusal check_shared(const trajectory::Primitive &p, const JointRange &move,
                         const JointRange &room) const noexcept;
    bool isSteady(const trajectory::Primitive &p, PathSample from, PathSample to) const noexcept;
    TravelToLimit limit_by_joints(const trajectory::Primitive &line, double sense, const TravelToLimit &axes,
                                  const Joints &joints, double turn) const noexcept;

    const kinematics::Kinematics &kinematics_;
    KinematicsMap map_;
    int num_joints_;
    PathLimits limits_;
    Joints end_joints_{};
    std::uint32_t position_changes_ = 0;  ///< of the limits
};

}  // namespace mw::motion
