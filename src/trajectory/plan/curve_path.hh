// SPDX-License-Identifier: GPL-2.0-or-later
// Makes a curve of the moves: spans, seams between them, positions of stops, and the feeds of the moves.
#pragma once

#include <deque>
#include <vector>

#include "trajectory/curve/curve_builder.hh"
#include "trajectory/curve/exact_builder.hh"
#include "trajectory/path/conditions.hh"
#include "trajectory/path/planned_path.hh"
#include "trajectory/plan/move_feeds.hh"
#include "trajectory/plan/pass_builder.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::plan {

using curve::SAME_PLACE;

/// Use it in the planner thread only. Moves with a tolerance are fitted, the others are followed exactly.
/// Where this rule changes, the curve is on the programmed path.
class CurvePath {
  public:
    CurvePath(PathStore &store, PlannedPath &moves);

    /// Begins a path at `start`, with s = 0.
    void begin(const Pose &start, const Conditions &conditions);
    /// True if the path has no move.
    bool isEmpty() const noexcept { return feeds().empty(); }
    /// Appends a move that starts at `end()`. Returns its number.
    Sequence add(const Conditions &conditions, const Primitive &primitive, const MoveRequest &request);
    /// No move follows now: the curve ends at the end of the last move.
    void release_end(const Conditions &conditions);
    /// Makes spans of the added moves.
    void extend(const Conditions &conditions);
    /// Drops spans and moves before `s`, where the motion is.
    void drop_before(double s);
    bool hasRoom() const noexcept;

    const Pose &end() const noexcept { return end_; }
    /// The pass that begins at `s`: its legs and the limits on all of them. It has no legs if more moves may
    /// follow.
    struct KnownPass {
        std::vector<PassLeg> legs;
        MotionLimits limits;
        double end_s = 0;
    };
    KnownPass pass_at(double s) const;
    /// True if all moves of the pass that begins at `s` are known.
    bool isPassKnown(double s) const noexcept;

    bool hasOpenEnd() const noexcept { return is_open_; }
    /// s at the end of the last move.
    double programmed_s() const noexcept { return programmed_s_; }
    /// s at the end of the known spans.
    double known_s() const noexcept { return spans_.empty() ? 0.0 : spans_.back().end_s(); }
    /// The first s after `s` where the motion stops with any following moves; 1e300: none.
    double stop_behind(double s) const noexcept;
    /// The move at `s`. At the end of a move it is the next one.
    Sequence move_at(double s) const noexcept { return feeds_.move_at(s); }
    Sequence first_move() const noexcept { return feeds_.first_move(); }
    Sequence span_at(double s) const noexcept;
    /// Returns the end of a span that equals `s` up to rounding, otherwise `s`.
    double on_span_end(double s) const noexcept;
    Sequence last_span() const noexcept { return first_span_ + spans_.size() - 1; }

    const std::vector<curve::Span> &spans() const noexcept { return spans_; }
    const std::vector<profile::SpeedCap> &caps() const noexcept { return caps_; }
    /// Feeds of the moves from first_move() on.
    const std::vector<profile::FeedLimit> &feeds() const noexcept { return feeds_.limits(); }
    const MoveFeeds &move_feeds() const noexcept { return feeds_; }
    MoveFeeds &move_feeds() noexcept { return feeds_; }
    bool isMadeFor(const Conditions &conditions) const noexcept;
    const profile::CurveLimits &limits() const noexcept { return limits_; }
    /// Inverse kinematics; null: the joints are axes.
    const JointMap *joint_map() const noexcept { return map_; }
    const JointLimits &joint_limits() const noexcept { return joints_; }

  private:
    enum class Rule : std::uint8_t { FITTED, EXACT, LOCKED };
    Rule rule_of(const Conditions &conditions, const MoveRequest &request, double tolerance) const noexcept;
    bool isStopBefore(const Conditions &conditions, const PlannedMove &last, const PlannedMove &move,
                      Rule rule) const noexcept;
    void begin_part();
    double append(const Conditions &conditions, const PlannedMove &move, const Primitive &primitive,
                  double tolerance);
    double tolerance_of(const Conditions &conditions, const Primitive &primitive,
                        const MoveRequest &request) const noexcept;
    void finish_part(const Conditions &conditions);
    void take_spans(const Conditions &conditions);
    void publish();
    void take_seam(const Conditions &conditions, const curve::Seam &seam);
    void add_stop(double s);

    PathStore &store_;
    PlannedPath &moves_;
    MoveFeeds feeds_;
    profile::CurveLimits limits_;
    bool is_jerk_limited_ = false;
    const JointMap *map_ = nullptr;
    JointLimits joints_;
    Pose end_;
    double programmed_s_ = 0;
    bool is_open_ = false;        ///< the last part of the path may still grow
    bool is_part_seamed_ = true;  ///< the seam before this part is known
    Rule rule_ = Rule::EXACT;
    curve::CurveBuilder fitted_;
    curve::ExactBuilder exact_;
    PassBuilder passes_;
    Sequence first_span_ = 1;
    std::vector<curve::Span> spans_;   ///< spans in the store
    std::vector<curve::Span> coming_;  ///< spans for which the store has no space yet
    curve::Span newest_;
    std::vector<curve::Seam> seams_;
    std::vector<profile::SpeedCap> caps_;
    std::vector<LimitedLeg> legs_;
    std::deque<double> stops_;
};

}  // namespace mw::trajectory::plan
