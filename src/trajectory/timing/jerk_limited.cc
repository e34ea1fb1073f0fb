// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/jerk_limited.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// One appending of phases: lives for a step.
class Smooth {
  public:
    Smooth(PlanDraft &draft, PathStore &store, const TimingView &view) noexcept
        : draft_(draft), store_(store), view_(view), path_(view.path()), limits_(view.on.conditions.limits) {}

    bool advance() noexcept;
    bool stop(const StopShape &shape) noexcept;

  private:
    bool canCoast(Sequence piece, double x, double v) noexcept;
    bool rise(double cap) noexcept;
    void coast(double cap, double out2) noexcept;
    double chosen_cap(double cap) noexcept;
    bool start(double cap) noexcept;
    void move(const Piece &p, double cap) noexcept;
    bool mustCoast(const StopShape &shape, const Piece &p) const noexcept;
    double softened(const Piece &p, const Piece::BrakeLeg &leg, double share) const noexcept;
    bool brake(const StopShape &shape, double soft_until_s) noexcept;
    double out2(Sequence piece) const noexcept { return view_.profile.out2(path_, piece); }
    void look_at(Sequence piece) noexcept { draft_.looked_at = std::max(draft_.looked_at, piece); }

    PlanDraft &draft_;
    PathStore &store_;
    const TimingView &view_;
    const PlannedPath &path_;
    const PathLimits &limits_;
};

/// True when the speed can be kept for the averaging time from here, and everything after that still keeps
/// its limits.
bool Smooth::canCoast(Sequence piece, double x, double v) noexcept {
    double way = v * limits_.filter_s();
    const double v2 = v * v * (1.0 - TimingTuning::SAME_SPEED);
    for (Sequence k = piece; k <= path_.last_piece(); ++k, x = 0) {
        look_at(k);
        const Piece &p = path_.piece(k);
        const double left = p.length - x;
        const double out = out2(k);
        if (way < left) {
            return v2 <= p.acceleration.highest_before(out, left - way);
        }
        if (v2 > out) {
            return false;
        }
        way -= left;
    }
    return false;
}

/// Accelerates as far as the piece, the cap and the later pieces allow; false when that is next to nothing.
bool Smooth::rise(double cap) noexcept {
    const LeaderState &s = draft_.at;
    const Piece &p = path_.piece(s.piece);
    const double v2 = s.v * s.v;
    const double left = p.length - s.x;
    const double top = std::min(cap, std::sqrt(p.acceleration.highest_before(v2, left)));
    const auto way_to = [&](double v) {
        const double a = p.acceleration.at(v * v);
        return a > 0 ? std::min(left, (v * v - v2) / (2.0 * a)) : left;
    };
    double v = top;
    if (!canCoast(s.piece, s.x + way_to(v), v)) {
        double low = s.v;
        double high = top;
        for (int i = 0; i < TimingTuning::RISE_STEPS; ++i) {
            const double middle = 0.5 * (low + high);
            (canCoast(s.piece, s.x + way_to(middle), middle) ? low : high) = middle;
        }
        v = low;
    }
    const bool isWorthIt = v > s.v * (1.0 + TimingTuning::RISE_WORTH) &&
                           (v == top || v - s.v > TimingTuning::PART_RISE_WORTH * v);
    if (isWorthIt) {
        draft_.append(store_, way_to(v), v);
    }
    return isWorthIt;
}

/// Keeps the speed until it may rise or must fall.
void Smooth::coast(double cap, double out2) noexcept {
    const LeaderState &s = draft_.at;
    const Piece &p = path_.piece(s.piece);
    const double left = p.length - s.x;
    const double v2 = s.v * s.v;
    const double brake = v2 > out2 ? (v2 - out2) / (2.0 * p.acceleration.at(v2)) : 0.0;
    double way = std::max(0.0, left - brake);
    const double since_s = s.v < cap ? s.coasting.since_fall_s : s.coasting.since_rise_s;
    const double wait = limits_.filter_s() - since_s;
    if (wait > TimingTuning::SOON && s.v != cap) {
        way = std::min(way, s.v * wait);
    }
    draft_.append(store_, std::max(way, TimingTuning::LEAST_COAST * left), s.v);
}

/// Maximum speed that the user's speed chooser sets for the rest of the piece. It does not control
/// acceleration.
double Smooth::chosen_cap(double cap) noexcept {
    std::array<ChosenPhase, CHOSEN_PHASES> phases;
    const LeaderState &s = draft_.at;
    if (view_.on.conditions.chooser == nullptr || s.v > cap) {
        return cap;
    }
    const int count = draft_.choose(view_, cap, out2(s.piece), phases);
    double top = 0;
    for (int n = 0; n < count; ++n) {
        top = std::max(top, phases[static_cast<std::size_t>(n)].speed);
    }
    return std::min(cap, top);
}

/// From standstill; false when the plan ends with it.
bool Smooth::start(double cap) noexcept {
    LeaderState &s = draft_.at;
    const PlannedPiece &plan = path_.plan(s.piece);
    const double stand = s.x <= 0 && plan.isStopBefore ? plan.dwell_s : limits_.filter_s();
    const double wait = stand - s.coasting.since_fall_s;
    if (wait > TimingTuning::SOON) {
        draft_.wait(store_, wait);
    }
    s.coasting = {};
    return rise(cap);
}

/// Falls, rises or keeps the speed on the piece.
void Smooth::move(const Piece &p, double cap) noexcept {
    LeaderState &s = draft_.at;
    const double tau = limits_.filter_s();
    const double v2 = s.v * s.v;
    const double left = p.length - s.x;
    const double out = out2(s.piece);
    const bool mustFall = v2 >= p.acceleration.highest_before(out, left) * (1.0 - TimingTuning::SAME_SPEED);
    const double a = p.acceleration.at(v2);
    const bool isOverCap = s.v > cap * (1.0 + TimingTuning::SAME_SPEED);
    if (isOverCap && s.coasting.since_rise_s >= tau - TimingTuning::SOON) {
        const double excess = v2 - cap * cap;
        const bool isShort = excess < 2.0 * a * left;
        draft_.append(store_, isShort ? excess / (2.0 * a) : left,
                      isShort ? cap : std::sqrt(v2 - 2.0 * a * left));
    } else if (mustFall) {
        const double slowest2 = v2 - 2.0 * a * left;
        const bool isFit = slowest2 <= out + TimingTuning::STOP_FIT * v2;
        const double end = std::sqrt(isFit ? std::min(out, v2) : slowest2);
        draft_.append(store_, left, end > s.v * (1.0 - TimingTuning::SAME_SPEED) ? s.v : end);
        s.x = p.length;
    } else {
        const bool mayRise = s.coasting.since_fall_s >= tau - TimingTuning::SOON &&
                             s.v < cap * (1.0 - TimingTuning::SAME_SPEED);
        if (!mayRise || !rise(cap)) {
            coast(cap, out);
        }
    }
    const double rounding = TimingTuning::ROUND_END * p.length;
    const bool isAtEnd = p.length - s.x <= rounding;
    s.x = isAtEnd ? p.length : s.x;
    if (isAtEnd && s.v > 0 && out <= 0 && s.v * s.v <= 4.0 * p.acceleration.at(0) * rounding) {
        // Braking from here takes less way than rounding.
        s.v = 0;
        draft_.wait(store_, limits_.period_s());
    }
}

/// Appends the next phase or two; false when the plan ends here for now.
bool Smooth::advance() noexcept {
    LeaderState &s = draft_.at;
    const Piece &p = path_.piece(s.piece);
    const bool isLast = s.piece == path_.last_piece();
    look_at(s.piece);
    draft_.reached = isLast && s.x >= p.length ? s.piece : 0;
    if (s.x >= p.length || (s.v <= 0 && p.length - s.x < TimingTuning::AT_END)) {
        if (isLast || (s.v <= 0 && isBarrier(view_.on, s.piece + 1))) {
            return false;
        }
        draft_.enter_next_piece();
        return true;
    }
    // The other half of the ring is for the stop.
    const bool isRoom = draft_.hasRoom(view_.oldest_phase, PHASE_CAPACITY / 2);
    if (!isRoom || draft_.overreach.kind != Overreach::Kind::NONE) {
        return false;
    }
    const double most = speed_cap(view_.on, s.piece);
    const double cap = s.v <= 0 && most <= 0 ? 0.0 : chosen_cap(most);
    if (draft_.overreach.kind != Overreach::Kind::NONE || (s.v <= 0 && cap <= 0)) {
        return false;
    }
    if (s.v <= 0) {
        return start(cap);
    }
    move(p, cap);
    return true;
}

/// The share of the leg's brake, more where what follows could not be kept or the speed were too high.
double Smooth::softened(const Piece &p, const Piece::BrakeLeg &leg, double share) const noexcept {
    const LeaderState &s = draft_.at;
    const double v2 = s.v * s.v;
    const double cap = speed_cap(view_.on, s.piece);
    const double kept2 = p.acceleration.highest_before(out2(s.piece), p.length - leg.end);
    const double needed = (v2 - std::min(kept2, std::max(v2, cap * cap))) / (2.0 * (leg.end - s.x));
    return std::clamp(needed, share * leg.a, leg.a);
}

bool Smooth::stop(const StopShape &shape) noexcept {
    const double soft_until_s = shape.first_share < 1 ? draft_.seconds + limits_.filter_s() : 0.0;
    while (draft_.at.v > 0) {
        const bool isRoom = draft_.hasRoom(view_.oldest_phase, TimingTuning::PHASES_PER_STOP);
        if (!isRoom || !brake(shape, soft_until_s)) {
            return false;
        }
    }
    return true;
}

/// An acceleration is still within the averaging time and the speed may be kept for now.
bool Smooth::mustCoast(const StopShape &shape, const Piece &p) const noexcept {
    const LeaderState &s = draft_.at;
    const double wait = shape.isAtOnce ? 0.0 : limits_.filter_s() - s.coasting.since_rise_s;
    const double kept2 = p.acceleration.highest_before(out2(s.piece), p.length - s.x);
    return wait > TimingTuning::SOON && s.v * s.v < kept2 * (1.0 - TimingTuning::SAME_SPEED);
}

/// Appends a phase of a stop, or continues on the next piece; false at the end of the path.
bool Smooth::brake(const StopShape &shape, double soft_until_s) noexcept {
    LeaderState &s = draft_.at;
    const Piece &p = path_.piece(s.piece);
    const bool isLast = s.piece == path_.last_piece();
    look_at(s.piece);
    const double v2 = s.v * s.v;
    const Piece::BrakeLeg leg =
        shape.isHard ? p.brake_leg(s.x, v2) : Piece::BrakeLeg{p.acceleration.at(v2), p.length};
    const double left = leg.end - s.x;
    if (!(left > 0)) {
        if (!isLast) {
            draft_.enter_next_piece();
        }
        return !isLast;
    }
    if (mustCoast(shape, p)) {
        coast(0, out2(s.piece));
        s.x = s.x > p.length * (1.0 - TimingTuning::ROUND_END) ? p.length : s.x;
        return true;
    }
    const double soft_s = soft_until_s - draft_.seconds;
    const bool isSoft = soft_s > TimingTuning::SOON;
    const double share = isSoft ? shape.first_share : shape.share;
    const double a = share < 1 ? softened(p, leg, share) : share * leg.a;
    const double soft_way = soft_s * (s.v - 0.5 * a * soft_s);
    if (isSoft && soft_way < left && a * soft_s < s.v) {
        draft_.append(store_, soft_way, s.v - a * soft_s);
        return true;
    }
    const double slowest2 = v2 - 2.0 * a * left;
    const bool isStop = leg.end >= p.length && (isLast || path_.plan(s.piece + 1).isStopBefore);
    if (isStop || slowest2 <= TimingTuning::STOP_FIT * v2) {
        // A stop that misses the end by rounding is fitted to it.
        draft_.append(store_, slowest2 < -TimingTuning::STOP_FIT * v2 ? v2 / (2.0 * a) : left, 0);
        return true;
    }
    draft_.append(store_, left, std::sqrt(slowest2));
    s.x = leg.end;
    return true;
}

}  // namespace

void append_smooth(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept {
    Smooth smooth(draft, store, view);
    while (draft.seconds < until_s && smooth.advance()) {
    }
}

bool append_stop(PlanDraft &draft, PathStore &store, const TimingView &view,
                 const StopShape &shape) noexcept {
    return Smooth(draft, store, view).stop(shape);
}

}  // namespace mw::trajectory
