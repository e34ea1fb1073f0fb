// SPDX-License-Identifier: GPL-2.0-or-later
// The known part of a curve from stop to stop, with its limits.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "trajectory/curve/spline.hh"
#include "trajectory/path/primitive.hh"
#include "trajectory/profile/curve_limits.hh"
#include "trajectory/profile/speed_cap.hh"

namespace mw::trajectory::profile {

using curve::CurvePoint;
using curve::Span;
using geometry::Pose;

/// Maximum speed of a move that ends at `end_s` on the programmed path.
struct FeedLimit {
    enum class Along : std::uint8_t {
        XYZ,
        UVW,
        LENGTH
    };  ///< length to which the speed refers; LENGTH: length of the programmed path
    double end_s = 0;
    double velocity = 1e300;
    Along along = Along::XYZ;
    double limit_share = 1;  ///< fraction of the velocity limits that the move may use (rapid override)
    /// Fraction of the speed at which the curve alone uses a limit (G64 R), LEAST_CURVE_SHARE to 1.
    double curve_share = 1;
    /// The fraction of a creep. Every plan starts with a creep, which must be within the speed limits.
    static constexpr double LEAST_CURVE_SHARE = 0.15;
    /// Squared derivative of this length by s, divided by the squared velocity.
    double share(const Pose &first) const noexcept;
};

/// The known part of a curve from stop to stop.
struct Run {
    const std::vector<Span> *spans = nullptr;
    const std::vector<FeedLimit> *feeds = nullptr;  ///< in order, at least up to `end_s`
    CurveLimits limits;
    double end_s = 0;       ///< end of the part that may be executed, within the spans
    bool has_stop = false;  ///< the motion stops there; otherwise more of the curve will follow
    /// Caps in order, without those that need a stop: the run ends there. Null: none.
    const std::vector<SpeedCap> *caps = nullptr;
    /// Inverse kinematics of joints that are not axes. Null: only the limits of the axes apply.
    const JointMap *map = nullptr;
    JointLimits joints{};
    double cap_reach = 0;                            ///< set by find_cap_reach()
    const curve::JointCurve *joint_curve = nullptr;  ///< set by add_joints()

    /// Sets `cap_reach` to the maximum reach of a cap.
    void find_cap_reach() noexcept;
    /// Calculates the joints of a machine whose joints are not axes, from `from_s` on. `accuracy`: limits
    /// that determine the interpolation error. If the kinematics has no solution, the run ends before that
    /// point with a stop.
    void add_joints(curve::JointCurve &curve, const JointLimits &accuracy, double from_s);
    /// Calls `take` with each cap whose reach overlaps [from, to].
    template <typename Take>
    void each_cap(double from, double to, const Take &take) const {
        if (caps == nullptr) {
            return;
        }
        auto cap = std::partition_point(caps->begin(), caps->end(),
                                        [&](const SpeedCap &c) { return c.s + cap_reach < from; });
        for (; cap != caps->end() && cap->s - cap_reach <= to; ++cap) {
            if (cap->s + cap->reach >= from && cap->s - cap->reach <= to) {
                take(*cap);
            }
        }
    }
    bool hasCap(double from, double to) const noexcept {
        bool has = false;
        each_cap(from, to, [&](const SpeedCap &) { has = true; });
        return has;
    }
    /// Index of the feed at s.
    std::size_t feed_at(double s) const noexcept;
};

/// Index of the span at s.
std::size_t span_at(const std::vector<Span> &spans, double s) noexcept;
/// Rounding error of a length along the programmed path, which is a sum of lengths.
constexpr double square(double x) noexcept {
    return x * x;
}
inline double rounding_at(double s) noexcept {
    return 1e-12 * std::max(1.0, std::abs(s));
}

}  // namespace mw::trajectory::profile
