// SPDX-License-Identifier: GPL-2.0-or-later
// From moves to a curve: spans, seams between them, places of stops, and the feeds of the moves.
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

/// Planner thread. Moves with a tolerance are fitted, the others are followed exactly. A part of the path
/// with one of the two rules ends on the programmed path.
class CurvePath {
  public:
    CurvePath(PathStore &store, PlannedPath &moves);

    /// A path begins at `start`, at the place 0.
    void begin(const Pose &start, const Conditions &conditions);
    /// It has no move so far.
    bool isEmpty() const noexcept { return feeds().empty(); }
    /// Appends a move that starts at `end()`. Returns its number.
    Sequence add(const Conditions &conditions, const Primitive &primitive, const MoveRequest &request);
    /// Nothing follows for now: the curve ends at the end of the last move.
    void release_end(const Conditions &conditions);
    /// Makes spans of the moves that were added.
    void extend(const Conditions &conditions);
    /// The motion is behind `s`.
    void drop_before(double s);
    bool hasRoom() const noexcept;

    const Pose &end() const noexcept { return end_; }
    /// The pass that begins at `s`: its legs, and the limits that all of them keep. None as long as it
    /// may still grow.
    struct KnownPass {
        std::vector<PassLeg> legs;
        MotionLimits limits;
        double end_s = 0;
    };
    KnownPass pass_at(double s) const;
    /// All moves of the pass that begins at `s` are known.
    bool isPassKnown(double s) const noexcept;

    bool hasOpenEnd() const noexcept { return is_open_; }
    /// Place of the end of the last move.
    double programmed_s() const noexcept { return programmed_s_; }
    /// Place of the end of the spans that are known.
    double known_s() const noexcept { return spans_.empty() ? 0.0 : spans_.back().end_s(); }
    /// The first place behind `s` at which the motion stops with any moves that follow; 1e300: none.
    double stop_behind(double s) const noexcept;
    /// The move at `s`; where two meet, the second one.
    Sequence move_at(double s) const noexcept { return feeds_.move_at(s); }
    Sequence first_move() const noexcept { return feeds_.first_move(); }
    Sequence span_at(double s) const noexcept;
    /// The end of a span at `s` up to rounding; otherwise `s`.
    double on_span_end(double s) const noexcept;
    Sequence last_span() const noexcept { return first_span_ + spans_.size() - 1; }

    const std::vector<curve::Span> &spans() const noexcept { return spans_; }
    const std::vector<profile::SpeedCap> &caps() const noexcept { return caps_; }
    /// Those of the moves from first_move() on.
    const std::vector<profile::FeedLimit> &feeds() const noexcept { return feeds_.limits(); }
    const MoveFeeds &move_feeds() const noexcept { return feeds_; }
    MoveFeeds &move_feeds() noexcept { return feeds_; }
    bool isMadeFor(const Conditions &conditions) const noexcept;
    const profile::CurveLimits &limits() const noexcept { return limits_; }
    /// Null: the joints are axes.
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
    bool is_part_seamed_ = true;  ///< the seam between this part and the one before is known
    Rule rule_ = Rule::EXACT;
    curve::CurveBuilder fitted_;
    curve::ExactBuilder exact_;
    PassBuilder passes_;
    Sequence first_span_ = 1;
    std::vector<curve::Span> spans_;   ///< that the executor may read
    std::vector<curve::Span> coming_;  ///< that have no room there yet
    curve::Span newest_;
    std::vector<curve::Seam> seams_;
    std::vector<profile::SpeedCap> caps_;
    std::vector<LimitedLeg> legs_;
    std::deque<double> stops_;
};

}  // namespace mw::trajectory::plan
