// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are not axes along a curve: polynomials of s, calculated with the inverse kinematics.
//
// A span is divided into parts. In each part, a polynomial of degree six interpolates the joints at Chebyshev
// nodes. A part is halved until the jerk of the interpolation error is small compared with the jerk limit, at
// the maximum speed that the joint limits allow.
#pragma once

#include <array>
#include <vector>

#include "trajectory/curve/spline.hh"
#include "trajectory/path/joint_map.hh"

namespace mw::trajectory::curve {

using PerJoint = std::array<double, MAX_JOINTS>;

/// Derivatives of the joints by s.
struct JointPoint {
    PerJoint first{}, second{}, third{};
};

/// Use it in the planner thread only. It calls the kinematics for each node of a span and for both ends of
/// each part.
class JointCurve {
  public:
    static constexpr std::size_t NODES = 7;

    /// A part of a span.
    struct Part {
        double start_s = 0, length = 0;
        double speed = 0;  ///< speed far within the limits of every joint, if it changes slowly [1/s]
        std::array<PerJoint, NODES> c{};  ///< [power of (s - start_s)/length][joint]
        double end_s() const noexcept { return start_s + length; }
    };

    /// Removes all parts. `map` null: only the limits of the axes apply.
    void begin(const JointMap *map, const JointLimits &limits) noexcept;
    /// Calculates the parts of the spans after those that are known.
    void cover(const std::vector<Span> &spans);
    void drop_before(double s);

    std::size_t joints() const noexcept {
        return map_ == nullptr ? 0 : static_cast<std::size_t>(limits_.count);
    }
    const JointLimits &limits() const noexcept { return limits_; }
    /// Maximum first derivatives of the joints over all parts until now.
    const PerJoint &largest_first() const noexcept { return largest_first_; }
    /// From this s on, the kinematics has no solution or a joint jumps; 1e300: no such point found.
    double drivable_s() const noexcept { return drivable_s_; }
    const std::vector<Part> &parts() const noexcept { return parts_; }
    /// Index of the part at `s`.
    std::size_t part_at(double s) const noexcept;
    JointPoint point_at(std::size_t part, double s) const noexcept;

  private:
    /// Calculates the polynomials of a part from the joints at its nodes. False if the kinematics has no
    /// solution at a node.
    bool interpolate(const Span &span, Part &part) const noexcept;
    void lay(const Span &span, double from, double length, int depth);
    double error_of(const Span &span, const Part &part, double &jump) const noexcept;
    double speed_at(const Part &part, double x) const noexcept;

    const JointMap *map_ = nullptr;
    JointLimits limits_;
    std::vector<Part> parts_;
    PerJoint largest_first_{};
    double covered_s_ = -1e300;
    double drivable_s_ = 1e300;
};

/// Jumps of the first two derivatives of the joints at a seam.
struct JointJump {
    PerJoint first{}, second{};  ///< absolute values of the jumps
    PerJoint before{}, after{};  ///< absolute values of the first derivative
    bool exists = false;         ///< the kinematics has a solution at the seam
};
JointJump joint_jump(const CurvePoint &before, const CurvePoint &after, const JointMap &map) noexcept;

}  // namespace mw::trajectory::curve
