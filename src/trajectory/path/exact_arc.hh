// SPDX-License-Identifier: GPL-2.0-or-later
// Speed and acceleration of arcs that must be followed exactly: they lie between stops, and the position on
// them is averaged. Formulas: docs/developer/planner.md.
#pragma once

#include <array>

#include "trajectory/path/braking.hh"
#include "trajectory/path/planned_path.hh"

namespace mw::trajectory {

bool isExactArc(const Primitive &p, const MoveRequest &request, const PathLimits &limits) noexcept;

/// A stretch of one has one speed. Its parts may take more acceleration along than the whole, where the axes
/// and joints that limit it move little.
class ExactArc {
  public:
    /// `stretch`: from its offset over its length. `wish`: requested maximum speed along the parameter.
    ExactArc(const PathStore &store, const Piece &stretch, const Conditions &conditions,
             double wish) noexcept;

    struct Allowance {
        SpeedLimit speed;
        Braking braking;  ///< of stops: the slower, the more turning leaves
    };
    Allowance allowance_of(const Piece &part) const noexcept;

  private:
    using PerJoint = std::array<double, MAX_JOINTS>;
    /// Largest derivatives at the averaged positions that belong to a part of the reference.
    struct Seen {
        PerLimited q1, q2;
        PerJoint joint_q1, joint_q2;
    };

    void slow_down_for_joints(const Piece &stretch) noexcept;
    Seen seen(const Piece &part) const noexcept;
    Braking braking_of(const Seen &part) const noexcept;
    double acceleration_at(const Seen &part, double v) const noexcept;
    double acceleration_of_axes(const Seen &part, double v) const noexcept;
    double acceleration_of_joints(const Seen &part, double v) const noexcept;

    const PathStore &store_;
    const Primitive &arc_;
    const Limits &wanted_;
    const Workspace &workspace_;
    double tau_, v_;
    PerLimited q1_, q2_;               ///< largest derivatives on the full circles that it lies on
    PerJoint joint_q1_{}, joint_k_{};  ///< of joints, each as on a circle with its curvature; q1 0: stopped
};

}  // namespace mw::trajectory
