// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are not axes, along a curve: polynomials of the place, from the inverse kinematics.
//
// A span is cut into parts. On each the joints are interpolated at Chebyshev's nodes by a polynomial of
// degree six; a part is halved until the jerk of the interpolation's error is small against the limit at the
// maximum speed that the joints allow there.
#pragma once

#include <array>
#include <vector>

#include "trajectory/curve/spline.hh"
#include "trajectory/path/joint_map.hh"

namespace mw::trajectory::curve {

using PerJoint = std::array<double, MAX_JOINTS>;

/// Derivatives of the joints by the place s.
struct JointPoint {
    PerJoint first{}, second{}, third{};
};

/// Planner thread. The map is called once for each node of a span.
class JointCurve {
  public:
    static constexpr std::size_t NODES = 7;

    /// A part of a span.
    struct Part {
        double start_s = 0, length = 0;
        double speed = 0;  ///< at which every joint keeps its limits by far, if it changes slowly [1/s]
        std::array<PerJoint, NODES> c{};  ///< [power of (s - start_s)/length][joint]
        double end_s() const noexcept { return start_s + length; }
    };

    /// `map` may be null: there are no joints to take into account. Forgets all parts.
    void begin(const JointMap *map, const JointLimits &limits) noexcept;
    /// Computes the parts of the spans that end behind those known so far.
    void cover(const std::vector<Span> &spans);
    void drop_before(double s);

    std::size_t joints() const noexcept {
        return map_ == nullptr ? 0 : static_cast<std::size_t>(limits_.count);
    }
    const JointLimits &limits() const noexcept { return limits_; }
    /// Largest first derivatives of the joints over all parts so far.
    const PerJoint &largest_first() const noexcept { return largest_first_; }
    /// From here on there are poses without joints, or joints that jump; 1e300: not found so far.
    double drivable_s() const noexcept { return drivable_s_; }
    const std::vector<Part> &parts() const noexcept { return parts_; }
    /// Index of the part at `s`.
    std::size_t part_at(double s) const noexcept;
    JointPoint point_at(std::size_t part, double s) const noexcept;

  private:
    /// The joints at the nodes of a part, at its two ends and at the middle between.
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
    PerJoint first{}, second{};  ///< sizes of the jumps
    PerJoint before{}, after{};  ///< sizes of the first derivative
    bool exists = false;         ///< there are joints at the pose
};
JointJump joint_jump(const CurvePoint &before, const CurvePoint &after, const JointMap &map) noexcept;

}  // namespace mw::trajectory::curve
