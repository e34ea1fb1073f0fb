// SPDX-License-Identifier: GPL-2.0-or-later
// Passes that follow the angle of a spindle: the curve of their moves, its corners, and what the machine
// allows along it. Formulas: docs/integrator/spindles.md.
#pragma once

#include <vector>

#include "trajectory/curve/exact_builder.hh"
#include "trajectory/path/conditions.hh"
#include "trajectory/path/limited_motion.hh"
#include "trajectory/path/planned_path.hh"

namespace mw::trajectory::plan {

/// Velocity, acceleration and jerk along a line, within the limits of all coordinates.
MotionLimits limits_along(const Primitive &line, const Limits &limits) noexcept;

/// A leg and what the machine allows along it.
struct LimitedLeg {
    PassLeg leg;
    double acceleration = 0, jerk = 0;
};

/// A move of a pass: a line, or an arc alone.
struct PassMove {
    Primitive primitive;
    double per_turn = 0;  ///< distance along it per revolution
    double speed = 0;     ///< at the present speed of the spindle
};

/// Planner thread. A corner is passed at the speed of the spindle, with continuous curvature, and behind the
/// end of the first line, whose cut needs its full depth there; the second line ends at its programmed end.
class PassBuilder {
  public:
    explicit PassBuilder(double widest) noexcept : exact_(widest) {}

    /// A pass begins at the place `s`.
    void begin(double s) noexcept;
    /// The move continues the pass without a stop.
    bool continues(const PassMove &move) const noexcept;
    /// The next move of the pass. Returns its length along the curve, which a moved corner changes.
    double add(const PassMove &move, const Conditions &conditions);
    /// The last move is known.
    void finish(const Limits &limits);
    /// Appends what there is to `spans` and `legs`; the builder forgets it.
    void move_parts(std::vector<curve::Span> &spans, std::vector<LimitedLeg> &legs);

  private:
    struct Corner {
        double half = 0;    ///< of its length; 0: none
        double behind = 0;  ///< it turns this far behind the end of the first line
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
    PassMove open_;        ///< the last move, as it is driven
    double per_unit_ = 0;  ///< its revolutions per unit of the curve
    double driven_ = 0;    ///< of it, by the corner before
};

/// Speed that the pass from this move on needs at the present speed of its spindle, over what the machine and
/// the operator allow.
double pass_load(const PlannedPath &path, const Conditions &conditions, Sequence move) noexcept;

/// Speeds at the ends of the legs from which all that follows can be kept. From the last one to the first.
void limit_leg_ends(std::vector<PassLeg> &legs, const MotionLimits &limits) noexcept;

}  // namespace mw::trajectory::plan
