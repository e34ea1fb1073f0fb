// SPDX-License-Identifier: GPL-2.0-or-later
// What planner and executor share: geometry, timing and commits from the planner; the state from the
// executor. Both sides live in one process; each array element has one writer, each counter one writer.
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

/// Counts moves, spans, cells and primitives from 1 on; an element n lives in slot n modulo the capacity.
using Sequence = std::uint64_t;

/// Who a stretch of path belongs to; plain data that planner and executor only carry.
struct MoveTag {
    std::uint64_t id = 0;
    std::int32_t line = 0;
    std::uint32_t file_index = 0;
    std::uint32_t block = 0;
    std::uint8_t type = 0;
    bool isProbe = false;
    bool isProbeAway = false;       ///< trips when contact is lost
    double requested_velocity = 0;  ///< along the feed length; 0: as fast as the limits allow
    double feed_ratio = 1;          ///< s per feed length
    double end_s = 0;               ///< where it ends on the programmed path
    Pose end;
};

/// A tap along a line: x is 0 at the start and `depth` at the bottom.
struct TapTerms {
    double depth = 0;
    double per_turn = 0;    ///< distance along x per revolution
    double back_scale = 1;  ///< spindle speed of the retract over that of the cut
    double low = 0;         ///< x stays above
    double high = 0;        ///< and below
    double velocity = 0;    ///< highest along x
    double acceleration = 0;
    double jerk = 0;
};

/// A part of a pass with one rule of revolutions: their number per unit changes evenly along it.
struct PassLeg {
    double start_s = 0, length = 0;
    double turns = 0;                          ///< at its start, since the start of the pass
    double per_unit_in = 0, per_unit_out = 0;  ///< revolutions per unit at its ends
    double v_most = 0;                         ///< maximum speed
    double v_out = 0;                          ///< speed at its end from which all that follows can be kept
    /// Revolutions since the start of the pass, and per unit, at a place of the leg.
    double turns_at(double s) const noexcept;
    double per_unit_at(double s) const noexcept;
};

/// Along the curve from `start_s` to `end_s`, from rest to rest, locked to the angle of a spindle.
struct Pass {
    Sequence first = 0, last = 0;  ///< legs; 0: none
    double start_s = 0, end_s = 0;
    int spindle = 0;
    double direction = 1;     ///< -1: the spindle turns backwards
    double acceleration = 0;  ///< along the curve, on all legs
    double jerk = 0;
    bool is_tap = false;  ///< in along the line of the first move, and back to its start; no legs
    TapTerms tap;
    bool isAny() const noexcept { return is_tap || first != 0; }
};

/// A motion along the curve, in cells of time, with its stops: each begins behind a cell of the motion and
/// ends at rest. The last one begins behind the last cell, so the executor needs no planner to stop.
struct CurvePlan {
    struct Stop {
        Sequence behind = 0;          ///< the cell of the motion that is left
        Sequence begin = 0, end = 0;  ///< cells of the stop; none where the motion itself ends at rest
    };
    static constexpr std::size_t MOST_STOPS = 192;

    std::uint64_t plan = 0;       ///< increasing
    Sequence behind = 0;          ///< continues the present plan behind this cell; 0: begins at rest
    Sequence begin = 0, end = 0;  ///< cells
    std::uint64_t brakes = 0;  ///< Snapshot::brakes that a start at rest was made for; another value voids it
    std::uint64_t after = 0;   ///< Snapshot::plan that a start at rest was made for; another value voids it
    Sequence span = 0, move = 0;            ///< at the start, from rest
    Sequence last_span = 0, last_move = 0;  ///< that are known
    bool is_stop = false;                   ///< no motion: the present plan takes its next stop
    Pass pass;                              ///< instead of cells
    std::size_t stop_count = 0;
    std::array<Stop, MOST_STOPS> stops{};
};

enum class Motion : std::uint8_t { REST, LOCKED, CURVE };

/// The executor's state at the end of a servo cycle.
struct Snapshot {
    std::uint64_t cycle = 0;
    std::uint64_t plan = 0;    ///< the last plan that was taken
    std::uint64_t brakes = 0;  ///< counts holds at rest and dropped paths: plans made before are not taken
    std::uint64_t drops = 0;   ///< counts dropped paths; the planner starts afresh for each
    Motion motion = Motion::REST;
    bool isDropping = false;  ///< stopping, and what is left will be dropped
    bool isHeld = false;
    Sequence cell = 0;  ///< of the plan, and the time in it
    double time_in_cell = 0;
    bool isOnPath = false;  ///< `x` is a point of the present path
    double x = 0, v = 0;
    Sequence done_move = 0;  ///< moves completed by what is commanded
};

inline constexpr std::size_t PRIMITIVE_CAPACITY = 4096;
inline constexpr std::size_t SPAN_CAPACITY = 16384;
inline constexpr std::size_t CELL_CAPACITY = 32768;
inline constexpr std::size_t LEG_CAPACITY = 8192;

/// An output change at a place of the path.
struct PathEvent {
    Sequence after_move = 0;  ///< fires when this move is complete
    std::uint64_t drops = 0;  ///< Snapshot::drops of the path it belongs to; of another path it never fires
    bool isAnalog = false;
    std::int16_t index = 0;
    double value = 0;
};

/// Owned by the code that assembles the two sides; some megabytes, so never on a stack.
struct PathStore {
    RawArray<Primitive, PRIMITIVE_CAPACITY> primitives;
    RawArray<MoveTag, PRIMITIVE_CAPACITY> moves;
    RawArray<curve::Span, SPAN_CAPACITY> spans;
    RawArray<curve::TimeCell, CELL_CAPACITY> cells;
    RawArray<PassLeg, LEG_CAPACITY> legs;
    SpscRing<PathEvent, 1024> events;     ///< planner -> executor
    SpscRing<CurvePlan, 16> curve_plans;  ///< planner -> executor
    /// The last move that is known.
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
