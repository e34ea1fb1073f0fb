// SPDX-License-Identifier: GPL-2.0-or-later
// The known part of a curve from stop to stop, and the limits that hold on it.
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

/// Maximum speed of a move, up to `end_s` of the programmed path.
struct FeedLimit {
    enum class Along : std::uint8_t {
        XYZ,
        UVW,
        LENGTH
    };  ///< what the speed counts along; the last: length of the programmed path
    double end_s = 0;
    double velocity = 1e300;
    Along along = Along::XYZ;
    double limit_share = 1;  ///< part of the velocity limits that the move may use (rapid override)
    /// Part of the speed at which the curve alone takes a limit (G64 R), from LEAST_CURVE_SHARE.
    double curve_share = 1;
    /// That of a creep: the motion that every plan begins with keeps any speed limit above it.
    static constexpr double LEAST_CURVE_SHARE = 0.15;
    /// Square of the derivative of that length by s, over the squared velocity.
    double share(const Pose &first) const noexcept;
};

/// The known part of a curve from stop to stop.
struct Run {
    const std::vector<Span> *spans = nullptr;
    const std::vector<FeedLimit> *feeds = nullptr;  ///< in order, up to `end_s` at least
    CurveLimits limits;
    double end_s = 0;       ///< end of what may be driven, within the spans
    bool has_stop = false;  ///< the motion stops there; otherwise more will follow
    /// In order, those with a stop left out: the run ends there. Null: none.
    const std::vector<SpeedCap> *caps = nullptr;
    /// Joints that are not axes. Null: the axes' limits are all there are.
    const JointMap *map = nullptr;
    JointLimits joints{};
    double cap_reach = 0;                            ///< set by find_cap_reach()
    const curve::JointCurve *joint_curve = nullptr;  ///< set by add_joints()

    /// Sets the largest reach of a cap.
    void find_cap_reach() noexcept;
    /// Computes the joints of a machine whose joints are not axes, from `from_s` on, to the accuracy that
    /// `accuracy` needs. Where there are none the run ends before, with a stop.
    void add_joints(curve::JointCurve &curve, const JointLimits &accuracy, double from_s);
    /// Calls `take` with each cap whose reach touches [from, to].
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
    /// Index of the limit at s.
    std::size_t feed_at(double s) const noexcept;
};

/// The span at s.
std::size_t span_at(const std::vector<Span> &spans, double s) noexcept;
/// Rounding of a length along the programmed path, which is a sum of lengths.
inline double rounding_at(double s) noexcept {
    return 1e-12 * std::max(1.0, std::abs(s));
}

}  // namespace mw::trajectory::profile
