// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/timing/plan_to_stop.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

/// One appending of phases: lives for a step.
class Phases {
  public:
    Phases(PlanDraft &draft, PathStore &store, const TimingView &view) noexcept
        : draft_(draft), store_(store), view_(view), path_(view.path()), limits_(view.on.conditions.limits) {}

    bool advance() noexcept;
    bool stop() noexcept;

  private:
    bool isKept(double x, double v) noexcept;
    bool rise(double cap) noexcept;
    void keep_speed(double out2) noexcept;
    double chosen_cap(double cap) noexcept;
    void move(const Piece &p, double cap) noexcept;
    bool brake() noexcept;
    double out2(Sequence piece) const noexcept { return view_.profile.out2(path_, piece); }
    void look_at(Sequence piece) noexcept { draft_.looked_at = std::max(draft_.looked_at, piece); }

    PlanDraft &draft_;
    PathStore &store_;
    const TimingView &view_;
    const PlannedPath &path_;
    const PathLimits &limits_;
};

/// What follows can be kept from the place x of the present piece at the speed v.
bool Phases::isKept(double x, double v) noexcept {
    const Sequence k = draft_.at.piece;
    const Piece &p = path_.piece(k);
    look_at(x < p.length ? k : k + 1);
    const double v2 = v * v * (1.0 - TimingTuning::SAME_SPEED);
    return v2 <= (x < p.length ? p.acceleration.highest_before(out2(k), p.length - x) : out2(k));
}

/// Accelerates as far as the piece, the cap and the later pieces allow; false when that is next to nothing.
bool Phases::rise(double cap) noexcept {
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
    if (!isKept(s.x + way_to(v), v)) {
        double low = s.v;
        double high = top;
        for (int i = 0; i < TimingTuning::RISE_STEPS; ++i) {
            const double middle = 0.5 * (low + high);
            (isKept(s.x + way_to(middle), middle) ? low : high) = middle;
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

/// Keeps the speed until it must fall.
void Phases::keep_speed(double out2) noexcept {
    const LeaderState &s = draft_.at;
    const Piece &p = path_.piece(s.piece);
    const double left = p.length - s.x;
    const double v2 = s.v * s.v;
    const double brake = v2 > out2 ? (v2 - out2) / (2.0 * p.acceleration.at(v2)) : 0.0;
    draft_.append(store_, std::max(std::max(0.0, left - brake), TimingTuning::LEAST_COAST * left), s.v);
}

/// Maximum speed that the user's speed chooser sets for the rest of the piece. It does not control
/// acceleration.
double Phases::chosen_cap(double cap) noexcept {
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

/// Falls, rises or keeps the speed on the piece.
void Phases::move(const Piece &p, double cap) noexcept {
    LeaderState &s = draft_.at;
    const double v2 = s.v * s.v;
    const double left = p.length - s.x;
    const double out = out2(s.piece);
    const bool mustFall = v2 >= p.acceleration.highest_before(out, left) * (1.0 - TimingTuning::SAME_SPEED);
    const double a = p.acceleration.at(v2);
    const bool isOverCap = s.v > cap * (1.0 + TimingTuning::SAME_SPEED);
    if (isOverCap) {
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
        const bool mayRise = s.v < cap * (1.0 - TimingTuning::SAME_SPEED);
        if (!mayRise || !rise(cap)) {
            keep_speed(out);
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
bool Phases::advance() noexcept {
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
        return rise(cap);
    }
    move(p, cap);
    return true;
}

bool Phases::stop() noexcept {
    while (draft_.at.v > 0) {
        if (!draft_.hasRoom(view_.oldest_phase, TimingTuning::PHASES_PER_STOP) || !brake()) {
            return false;
        }
    }
    return true;
}

/// Appends a phase of a stop, or continues on the next piece; false at the end of the path.
bool Phases::brake() noexcept {
    LeaderState &s = draft_.at;
    const Piece &p = path_.piece(s.piece);
    const bool isLast = s.piece == path_.last_piece();
    look_at(s.piece);
    const double v2 = s.v * s.v;
    const double a = p.acceleration.at(v2);
    const double left = p.length - s.x;
    if (!(left > 0)) {
        if (!isLast) {
            draft_.enter_next_piece();
        }
        return !isLast;
    }
    const double slowest2 = v2 - 2.0 * a * left;
    const bool isStop = isLast || path_.plan(s.piece + 1).isStopBefore;
    if (isStop || slowest2 <= TimingTuning::STOP_FIT * v2) {
        // A stop that misses the end by rounding is fitted to it.
        draft_.append(store_, slowest2 < -TimingTuning::STOP_FIT * v2 ? v2 / (2.0 * a) : left, 0);
        return true;
    }
    draft_.append(store_, left, std::sqrt(slowest2));
    s.x = p.length;
    return true;
}

}  // namespace

void append_to_horizon(PlanDraft &draft, PathStore &store, const TimingView &view, double until_s) noexcept {
    Phases phases(draft, store, view);
    while (draft.seconds < until_s && phases.advance()) {
    }
}

bool append_stop(PlanDraft &draft, PathStore &store, const TimingView &view) noexcept {
    return Phases(draft, store, view).stop();
}

}  // namespace mw::trajectory
