// SPDX-License-Identifier: GPL-2.0-or-later
// Data that the planner and the executor share. The planner writes geometry, timing and commits, the executor
// writes its state. Both run in one process. Each array element and each counter has one writer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "base/copyable_atomic.hh"
#include "base/raw_array.hh"
#include "base/spsc_ring.hh"
#include "trajectory/curve/span.hh"
#include "trajectory/path/primitive.hh"

namespace mw::trajectory {

/// Number of a move, span, cell or primitive, from 1 on. Element n is in slot n modulo the capacity.
using Sequence = std::uint64_t;

/// Source of a part of the path. The planner and the executor only copy it.
struct MoveTag {
    std::uint64_t id = 0;
    std::int32_t line = 0;
    std::uint32_t file_index = 0;
    std::uint32_t block = 0;
    std::uint8_t type = 0;
    bool isProbe = false;
    bool isProbeAway = false;       ///< probing move that triggers when contact is lost
    double requested_velocity = 0;  ///< feed along the feed length [unit/s]; 0: no feed, only the limits
    double feed_ratio = 1;          ///< length of the move in s, divided by its feed length
    double end_s = 0;               ///< end of the move on the programmed path
    Pose end;
};

/// A tap along a line. x is 0 at the start and `depth` at the bottom [unit].
struct TapTerms {
    double depth = 0;
    double per_turn = 0;    ///< pitch: distance along x per revolution [unit]
    double back_scale = 1;  ///< spindle speed of the retract divided by that of the cut
    double low = 0;         ///< lower limit of x [unit]
    double high = 0;        ///< upper limit of x [unit]
    double velocity = 0;    ///< maximum velocity along x [unit/s]
    double acceleration = 0;
    double jerk = 0;
};

/// A part of a pass. The number of revolutions per unit of length changes linearly along it.
struct PassLeg {
    double start_s = 0, length = 0;
    double turns = 0;  ///< revolutions from the start of the pass to the start of the leg
    double per_unit_in = 0, per_unit_out = 0;  ///< revolutions per unit at the start and at the end
    double v_most = 0;                         ///< maximum speed along the curve [1/s]
    double v_out = 0;                          ///< maximum speed at its end that the rest of the pass allows
    /// Revolutions since the start of the pass, and revolutions per unit, at position `s` of the leg.
    double turns_at(double s) const noexcept;
    double per_unit_at(double s) const noexcept;
};

/// A motion along the curve from `start_s` to `end_s`, locked to the angle of a spindle. It starts and ends
/// at standstill.
struct Pass {
    Sequence first = 0, last = 0;  ///< numbers of the legs; 0: none
    double start_s = 0, end_s = 0;
    int spindle = 0;
    double direction = 1;     ///< -1: the spindle runs in reverse
    double acceleration = 0;  ///< maximum acceleration along the curve, on all legs [1/s^2]
    double jerk = 0;
    bool is_tap = false;  ///< a tap along the line of the first move and back to its start; it has no legs
    TapTerms tap;
    bool isAny() const noexcept { return is_tap || first != 0; }
};

/// A motion along the curve in cells, with its stops. Each stop begins at the end of a cell of the motion and
/// ends at standstill. The last stop begins at the end of the last cell, so the executor can stop without the
/// planner.
struct CurvePlan {
    struct Stop {
        Sequence behind = 0;  ///< the stop begins at the end of this cell of the motion
        /// Cells of the stop, `end` excluded; none if the motion itself ends at standstill.
        Sequence begin = 0, end = 0;
    };
    static constexpr std::size_t MOST_STOPS = 192;

    std::uint64_t plan = 0;  ///< number of the plan, increasing
    /// The plan continues the current plan from the end of this cell; 0: it begins at standstill.
    Sequence behind = 0;
    Sequence begin = 0, end = 0;  ///< cells of the motion, `end` excluded
    std::uint64_t brakes = 0;     ///< Snapshot::brakes for which a start from standstill was planned; with
                                  ///< another value the plan is ignored
    std::uint64_t after = 0;  ///< Snapshot::plan for which a start from standstill was planned; with another
                              ///< value the plan is ignored
    Sequence span = 0, move = 0;            ///< span and move at a start from standstill
    Sequence last_span = 0, last_move = 0;  ///< last known span and move
    bool is_stop = false;  ///< no motion: the executor takes the next stop of the current plan
    Pass pass;             ///< a pass instead of cells
    std::size_t stop_count = 0;
    std::array<Stop, MOST_STOPS> stops{};
};

enum class Motion : std::uint8_t { REST, LOCKED, CURVE };

/// State of the executor at the end of a servo cycle.
struct Snapshot {
    std::uint64_t cycle = 0;
    std::uint64_t plan = 0;  ///< number of the last accepted plan
    /// Count of holds at standstill and of dropped paths; plans made before are ignored.
    std::uint64_t brakes = 0;
    std::uint64_t drops = 0;  ///< count of dropped paths; the planner begins a new path after each
    Motion motion = Motion::REST;
    bool isDropping = false;  ///< the executor stops, and the rest of the path will be dropped
    bool isHeld = false;
    Sequence cell = 0;  ///< current cell of the plan
    double time_in_cell = 0;
    bool isOnPath = false;  ///< `x` is a point of the current path
    double x = 0, v = 0;
    Sequence done_move = 0;  ///< last move that the commanded motion has completed
};

inline constexpr std::size_t PRIMITIVE_CAPACITY = 4096;
inline constexpr std::size_t SPAN_CAPACITY = 16384;
inline constexpr std::size_t CELL_CAPACITY = 32768;
inline constexpr std::size_t LEG_CAPACITY = 8192;

/// An output change at a point of the path (M62, M63, M67).
struct PathEvent {
    Sequence after_move = 0;  ///< the output changes when this move is complete
    std::uint64_t drops = 0;  ///< Snapshot::drops of its path; the event is ignored on any other path
    bool isAnalog = false;
    std::int16_t index = 0;
    double value = 0;
};

/// Owned by the code that creates planner and executor. Its size is several megabytes: do not put it on a
/// stack.
struct PathStore {
    RawArray<Primitive, PRIMITIVE_CAPACITY> primitives;
    RawArray<MoveTag, PRIMITIVE_CAPACITY> moves;
    RawArray<curve::Span, SPAN_CAPACITY> spans;
    RawArray<curve::TimeCell, CELL_CAPACITY> cells;
    RawArray<PassLeg, LEG_CAPACITY> legs;
    SpscRing<PathEvent, 1024> events;     ///< from planner to executor
    SpscRing<CurvePlan, 16> curve_plans;  ///< from planner to executor
    /// Number of the last known move.
    CopyableAtomic<Sequence> last_move{0};

    Primitive &primitive(Sequence n) noexcept { return primitives[n % PRIMITIVE_CAPACITY]; }
    const Primitive &primitive(Sequence n) const noexcept { return primitives[n % PRIMITIVE_CAPACITY]; }
    MoveTag &move(Sequence n) noexcept { return moves[n % PRIMITIVE_CAPACITY]; }
    const MoveTag &move(Sequence n) const noexcept { return moves[n % PRIMITIVE_CAPACITY]; }
    curve::Span &span(Sequence n) noexcept { return spans[n % SPAN_CAPACITY]; }
    const curve::Span &span(Sequence n) const noexcept { return spans[n % SPAN_CAPACITY]; }
    curve::TimeCell &cell(Sequence n) noexcept { return cells[n % CELL_CAPACITY]; }
    const curve::TimeCell &cell(Sequence n) const noexcept { return cells[n % CELL_CAPACITY]; }
    PassLeg &leg(Sequence n) noexcept { return legs[n % LEG_CAPACITY]; }
    const PassLeg &leg(Sequence n) const noexcept { return legs[n % LEG_CAPACITY]; }
};

}  // namespace mw::trajectory
