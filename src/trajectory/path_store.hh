// SPDX-License-Identifier: GPL-2.0-or-later
// What planner and executor share: geometry, timing and commits from the planner; the state from the
// executor. Both sides live in one process; each array element has one writer, each counter one writer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "base/copyable_atomic.hh"
#include "base/raw_array.hh"
#include "base/spsc_ring.hh"
#include "trajectory/curve/span.hh"
#include "trajectory/path/primitive.hh"

namespace mw::trajectory {

/// Counts moves, pieces, phases and primitives from 1 on; an element n lives in slot n modulo the capacity.
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

/// Path acceleration that a piece allows, by the squared speed b: the least of some lines alpha - beta b.
struct AccelBound {
    static constexpr int LINES = 3;
    std::array<double, LINES> alpha{}, beta{};

    static AccelBound constant(double a) noexcept {
        AccelBound bound;
        bound.alpha.fill(a);
        return bound;
    }
    /// Through what is left at LimitTuning::CHORDS of the squared speed v^2.
    static AccelBound through(const double (&left)[LINES + 1], double v) noexcept;
    /// The lesser of two up to the speed v; chords of it, so on the safe side.
    static AccelBound least(const AccelBound &x, const AccelBound &y, double v) noexcept;
    /// At the squared speed b, never negative.
    double at(double b) const noexcept {
        double a = alpha[0] - beta[0] * b;
        for (std::size_t k = 1; k < LINES; ++k) {
            const double c = alpha[k] - beta[k] * b;
            a = c < a ? c : a;
        }
        return a > 0 ? a : 0;
    }
    /// Highest squared speed from which `length` suffices to come down to `b`.
    double highest_before(double b, double length) const noexcept {
        double best = (2.0 * length * alpha[0] + b) / (1.0 + 2.0 * length * beta[0]);
        for (std::size_t k = 1; k < LINES; ++k) {
            const double c = (2.0 * length * alpha[k] + b) / (1.0 + 2.0 * length * beta[k]);
            best = c < best ? c : best;
        }
        return best > b ? best : b;
    }
};

/// How hard a stop may brake on each part of a piece, parts of equal length, where that is more than what
/// speeds are planned with: by the squared speed, chords between parts of the highest.
struct Braking {
    static constexpr std::size_t PARTS = 6;
    static constexpr std::size_t MOST_NODES = 7;
    using Part = std::array<float, MOST_NODES>;  ///< [1/s^2]

    double top = 0;  ///< the highest squared speed; 0: nowhere more than planned
    std::array<Part, PARTS> parts{};

    /// Parts of `top` at which the bounds are known.
    std::span<const double> nodes() const noexcept;
    /// What a part allows at the squared speed b.
    double at(std::size_t part, double b) const noexcept;
    /// The part from `x` on, of a piece of `length`; the last one also behind its end.
    static std::size_t part_at(double x, double length) noexcept;
    /// Where parts that allow the same end.
    double end_of(std::size_t part, double length) const noexcept;
};

/// A segment of path with separate limits: a part of one primitive, or of a blend between two.
///   part:  q(x) = A(offset + x)
///   blend: q(x) = A(L - d + z - z^2/4d) + B(z^2/4d) - corner,  z = offset + x in [0, 2d], L the length of A
struct Piece {
    Sequence primitive = 0;  ///< A; B is the next one
    Sequence move = 0;       ///< the move of A; B's is the next one
    double offset = 0;       ///< s of A, or z of the blend, where the piece begins
    double length = 0;
    double blend_d = 0;       ///< 0: a part of A
    bool isToEnd = false;     ///< a part of A that reaches A's end
    AccelBound acceleration;  ///< along x, such that every axis keeps its limits [1/s^2]
    Braking braking;          ///< the same for stops, which the speeds are not planned with

    /// How hard a stop brakes from x on at the squared speed b: never less than speeds are planned with.
    double brake_at(double x, double b) const noexcept;
    /// The same until x = `end`: where the piece allows another, be it by the place or by a speed that has
    /// fallen.
    struct BrakeLeg {
        double a = 0, end = 0;
    };
    BrakeLeg brake_leg(double x, double b) const noexcept;
};

/// x(t) = x0 + v0 t + a t^2 / 2 + j t^3 / 6, t in [0, duration], on one piece.
struct Phase {
    Sequence piece = 0;
    double duration = 0;
    double x0 = 0, v0 = 0, a = 0, j = 0;

    /// Place and speed at the time t in it.
    double x_at(double t) const noexcept { return x0 + t * (v0 + t * (0.5 * a + t * j * (1.0 / 6.0))); }
    double v_at(double t) const noexcept { return v0 + t * (a + 0.5 * t * j); }
    /// It ends with a speed of 0, except for rounding.
    bool isStop(double period_s) const noexcept;
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

/// Phases for the executor. They never end with a stop after the committed part: when they run out, the
/// executor brakes along the pieces, and the planner has made sure that this is possible within the limits.
struct Commit {
    std::uint64_t plan = 0;  ///< increasing
    bool isSwitch = false;   ///< leave the present plan at `switch_cycle` for phases [begin, end)
    std::uint64_t switch_cycle = 0;
    std::uint64_t brakes = 0;     ///< Snapshot::brakes that the plan was made for; another value voids it
    Sequence begin = 0, end = 0;  ///< not a switch: the current plan `plan` now continues to `end`
};

/// A motion along the curve, in cells of time, with its stops: each begins behind a cell of the motion and
/// ends at rest. The last one begins behind the last cell, so the executor needs no planner to stop.
struct CurvePlan {
    struct Stop {
        Sequence behind = 0;          ///< the cell of the motion that is left
        Sequence begin = 0, end = 0;  ///< cells of the stop; none where the motion itself ends at rest
    };
    static constexpr std::size_t MOST_STOPS = 64;

    std::uint64_t plan = 0;       ///< increasing
    Sequence behind = 0;          ///< continues the present plan behind this cell; 0: begins at rest
    Sequence begin = 0, end = 0;  ///< cells
    std::uint64_t brakes = 0;  ///< Snapshot::brakes that a start at rest was made for; another value voids it
    Sequence span = 0, move = 0;            ///< at the start, from rest
    Sequence last_span = 0, last_move = 0;  ///< that are known
    bool is_stop = false;                   ///< no motion: the present plan takes its next stop
    Pass pass;                              ///< instead of cells
    std::size_t stop_count = 0;
    std::array<Stop, MOST_STOPS> stops{};
};

enum class Motion : std::uint8_t { REST, FOLLOW, BRAKE, LOCKED, CURVE };

/// The executor's state at the end of a servo cycle.
struct Snapshot {
    std::uint64_t cycle = 0;
    std::uint64_t plan = 0;    ///< the last switch that was taken
    std::uint64_t brakes = 0;  ///< counts how often the executor left a plan by itself
    std::uint64_t drops = 0;   ///< counts dropped paths; the planner starts afresh for each
    Motion motion = Motion::REST;
    bool isDropping = false;  ///< braking, and what is left will be dropped
    bool isHeld = false;
    Sequence phase = 0;  ///< FOLLOW: the phase and the time in it
    double time_in_phase = 0;
    bool isOnCurve = false;  ///< the path is a curve: `x` is the place on it, `phase` the cell
    Sequence piece = 0;      ///< where on the path; 0: no path, or a curve
    double x = 0, v = 0;
    Sequence done_move = 0;  ///< moves completed by what is commanded
};

inline constexpr std::size_t PRIMITIVE_CAPACITY = 4096;
inline constexpr std::size_t PIECE_CAPACITY = 16384;
inline constexpr std::size_t PHASE_CAPACITY = 65536;
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
    RawArray<Piece, PIECE_CAPACITY> pieces;
    RawArray<Phase, PHASE_CAPACITY> phases;
    RawArray<curve::Span, SPAN_CAPACITY> spans;
    RawArray<curve::TimeCell, CELL_CAPACITY> cells;
    RawArray<PassLeg, LEG_CAPACITY> legs;
    SpscRing<PathEvent, 1024> events;     ///< planner -> executor
    SpscRing<Commit, 64> commits;         ///< planner -> executor
    SpscRing<CurvePlan, 16> curve_plans;  ///< planner -> executor
    /// Pieces up to here may be read by the executor. Release by the planner after filling, acquire by the
    /// executor.
    CopyableAtomic<Sequence> last_piece{0};
    /// The last move of a curve that is known.
    CopyableAtomic<Sequence> last_move{0};

    Primitive &primitive(Sequence n) noexcept { return primitives[n % PRIMITIVE_CAPACITY]; }
    const Primitive &primitive(Sequence n) const noexcept { return primitives[n % PRIMITIVE_CAPACITY]; }
    MoveTag &move(Sequence n) noexcept { return moves[n % PRIMITIVE_CAPACITY]; }
    const MoveTag &move(Sequence n) const noexcept { return moves[n % PRIMITIVE_CAPACITY]; }
    Piece &piece(Sequence n) noexcept { return pieces[n % PIECE_CAPACITY]; }
    const Piece &piece(Sequence n) const noexcept { return pieces[n % PIECE_CAPACITY]; }
    curve::Span &span(Sequence n) noexcept { return spans[n % SPAN_CAPACITY]; }
    const curve::Span &span(Sequence n) const noexcept { return spans[n % SPAN_CAPACITY]; }
    curve::TimeCell &cell(Sequence n) noexcept { return cells[n % CELL_CAPACITY]; }
    const curve::TimeCell &cell(Sequence n) const noexcept { return cells[n % CELL_CAPACITY]; }
    PassLeg &leg(Sequence n) noexcept { return legs[n % LEG_CAPACITY]; }
    const PassLeg &leg(Sequence n) const noexcept { return legs[n % LEG_CAPACITY]; }
    Phase &phase(Sequence n) noexcept { return phases[n % PHASE_CAPACITY]; }
    const Phase &phase(Sequence n) const noexcept { return phases[n % PHASE_CAPACITY]; }
};

/// Position at `x` of a piece. [servo, planner]
[[gnu::hot]] Pose position_at(const PathStore &store, const Piece &piece, double x) noexcept;

/// dq/dx at `x` of a piece. [servo, planner]
Pose derivative_at(const PathStore &store, const Piece &piece, double x) noexcept;

}  // namespace mw::trajectory
