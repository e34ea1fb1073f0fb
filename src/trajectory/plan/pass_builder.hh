// SPDX-License-Identifier: GPL-2.0-or-later
// Passes that follow the angle of a spindle: the curve of their moves with its corners, and the limits along
// it. Formulas: docs/integrator/spindles.md.
#pragma once

#include <vector>

#include "trajectory/curve/exact_builder.hh"
#include "trajectory/path/conditions.hh"
#include "trajectory/path/limited_motion.hh"
#include "trajectory/path/planned_path.hh"

namespace mw::trajectory::plan {

/// Velocity, acceleration and jerk along a line, within the limits of all coordinates.
MotionLimits limits_along(const Primitive &line, const Limits &limits) noexcept;

/// A leg with its limits along the curve.
struct LimitedLeg {
    PassLeg leg;
    double acceleration = 0, jerk = 0;
};

/// A move of a pass: a line, or an arc between stops.
struct PassMove {
    Primitive primitive;
    double per_turn = 0;  ///< distance along the move per revolution
    double speed = 0;     ///< speed at the current spindle speed
};

/// Use it in the planner thread only. A corner is passed at the speed of the spindle, with continuous
/// curvature. It is shifted past the end of the first line, because the cut needs its full depth there. The
/// second line ends at its programmed end.
class PassBuilder {
  public:
    explicit PassBuilder(double widest) noexcept : exact_(widest) {}

    /// Begins a pass at path length `s`.
    void begin(double s) noexcept;
    /// True if the move continues the pass without a stop.
    bool continues(const PassMove &move) const noexcept;
    /// Adds the next move of the pass. Returns its length along the curve, which a shifted corner changes.
    double add(const PassMove &move, const Conditions &conditions);
    /// Completes the last move.
    void finish(const Limits &limits);
    /// Appends the spans and legs to `spans` and `legs` and removes them from the builder.
    void move_parts(std::vector<curve::Span> &spans, std::vector<LimitedLeg> &legs);

  private:
    struct Corner {
        double half = 0;    ///< half of its length; 0: no corner
        double behind = 0;  ///< distance of the corner past the end of the first line
    };
    Corner corner_to(const PassMove &next, const Conditions &conditions) const noexcept;
    void close(double length, const Limits &limits);
    void add_leg(const LimitedLeg &leg);
    void add_corner(const Corner &corner, const Primitive &next, double per_unit, const Limits &limits);

    curve::ExactBuilder exact_;
    std::vector<curve::Span> spans_;
    std::vector<curve::Seam> seams_;
    std::vector<LimitedLeg> legs_;
    double s_ = 0, turns_ = 0;
    bool is_open_ = false;
    PassMove open_;        ///< the last move, as it is executed
    double per_unit_ = 0;  ///< its revolutions per unit of the curve
    double driven_ = 0;    ///< part of its length that the corner before contains
};

/// Speed that the pass from this move on needs at the current spindle speed, divided by the maximum speed of
/// the machine and the operator.
double pass_load(const PlannedPath &path, const Conditions &conditions, Sequence move) noexcept;

/// Calculates the maximum speed at the end of each leg that the following legs allow, from the last leg to
/// the first.
void limit_leg_ends(std::vector<PassLeg> &legs, const MotionLimits &limits) noexcept;

}  // namespace mw::trajectory::plan
