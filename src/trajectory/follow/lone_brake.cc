// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/follow/lone_brake.hh"

#include <algorithm>
#include <array>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::trajectory {

namespace {

using geometry::AXIS_COUNT;

/// Where the leader is a cycle on, braking no harder than to stand then; never beyond the path.
Pose leader_ahead(const PathStore &store, const Snapshot &now, double brake, double period_s) noexcept {
    const Sequence last = store.last_piece.load(std::memory_order_acquire);
    Sequence n = now.piece;
    double x = now.x + period_s * (now.v - 0.5 * brake * period_s);
    for (int i = 0; i < ExecutorTuning::MOST_PIECES_PER_CYCLE && n < last && x > store.piece(n).length; ++i) {
        x -= store.piece(n).length;
        ++n;
    }
    return position_at(store, store.piece(n), std::min(x, store.piece(n).length));
}

/// The last three places that were commanded, newest first, and how the next one follows from the leader's.
class CommandedPlaces {
  public:
    CommandedPlaces(const PathStore &store, const Snapshot &now, const Pose &newest) noexcept
        : store_(store), now_(now), share_(1.0 / static_cast<double>(now.filter)) {
        places_[0] = newest;
        for (std::uint64_t back = 1; back < places_.size(); ++back) {
            places_[back] = places_[back - 1] - step(leader(back), back);
        }
    }
    const Pose &operator[](std::size_t back) const noexcept { return places_[back]; }
    Pose next(const Pose &ahead) const noexcept { return places_[0] + step(ahead, 0); }

  private:
    /// `back` cycles before the one that comes.
    Pose leader(std::uint64_t back) const noexcept {
        const std::uint64_t tick = now_.tick - back;
        return tick >= now_.first_tick ? store_.history[tick % HISTORY_CAPACITY].pose : now_.origin;
    }
    /// What the mean does in the cycle in which `in` comes into it.
    Pose step(const Pose &in, std::uint64_t back) const noexcept {
        return (in - leader(back + now_.filter)) * share_;
    }

    const PathStore &store_;
    const Snapshot &now_;
    double share_;
    std::array<Pose, 3> places_;
};

/// Third differences that are linear in the part of a range, over what is allowed of each.
class JerkRows {
  public:
    void add(double at_least, double at_most, double allowed) noexcept {
        if (allowed > 0 && allowed < NO_LIMIT) {
            rows_[count_++] = {at_least / allowed, (at_most - at_least) / allowed};
        }
    }
    void set_norm(const Pose &at_least, const Pose &at_most, double allowed) noexcept {
        hasNorm_ = allowed > 0 && allowed < NO_LIMIT;
        for (int i = 0; i < 3 && hasNorm_; ++i) {
            norm_[static_cast<std::size_t>(i)] = {at_least[i] / allowed,
                                                  (at_most[i] - at_least[i]) / allowed};
        }
    }
    /// The largest of them at a part of the range; convex.
    double load(double part) const noexcept {
        double most = 0;
        for (std::size_t i = 0; i < count_; ++i) {
            most = std::max(most, std::abs(rows_[i].at(part)));
        }
        const double norm = std::hypot(norm_[0].at(part), norm_[1].at(part), norm_[2].at(part));
        return hasNorm_ ? std::max(most, norm) : most;
    }
    /// The greatest part of the range with a load that is allowed, else the one with the least.
    double greatest() const noexcept {
        if (load(1) <= ExecutorTuning::FULL_JERK) {
            return 1;
        }
        double low = 0;
        double high = 1;
        for (int i = 0; i < ExecutorTuning::BRAKE_STEPS; ++i) {
            const double left = low + (high - low) / 3.0;
            const double right = high - (high - low) / 3.0;
            if (load(left) <= load(right)) {
                high = right;
            } else {
                low = left;
            }
        }
        double best = 0.5 * (low + high);
        double beyond = 1;
        for (int i = 0; i < ExecutorTuning::BRAKE_STEPS && load(best) <= ExecutorTuning::FULL_JERK; ++i) {
            const double middle = 0.5 * (best + beyond);
            (load(middle) <= ExecutorTuning::FULL_JERK ? best : beyond) = middle;
        }
        return best;
    }

  private:
    static constexpr double NO_LIMIT = 1e30;  // of a third difference
    struct Row {
        double least = 0, slope = 0;
        double at(double part) const noexcept { return least + slope * part; }
    };
    std::array<Row, AXIS_COUNT + MAX_JOINTS> rows_;
    std::array<Row, 3> norm_;
    std::size_t count_ = 0;
    bool hasNorm_ = false;
};

using Joints = std::array<double, MAX_JOINTS>;

/// The joints' rows; none where a place has no joints: the controller tells of that.
void add_joints(JerkRows &rows, const CommandedPlaces &places, const Pose &gentle, const Pose &hard,
                const StopLimits &limits, double cube) noexcept {
    const std::array<const Pose *, 5> poses{&gentle, &hard, &places[0], &places[1], &places[2]};
    std::array<Joints, poses.size()> joints{};
    for (std::size_t i = 0; i < poses.size(); ++i) {
        if (!limits.map->joints_at(*poses[i], joints[i].data())) {
            return;
        }
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(limits.joints.count); ++j) {
        const double before = 3.0 * (joints[2][j] - joints[3][j]) + joints[4][j];
        rows.add(joints[0][j] - before, joints[1][j] - before, limits.joints.jerk[j] * cube);
    }
}

/// The squared speed of a phase at `x` of its piece.
double squared_speed(const Phase &phase, double x) noexcept {
    return std::max(0.0, phase.v0 * phase.v0 + 2.0 * phase.a * (x - phase.x0));
}

}  // namespace

double least_brake(const PathStore &store, const Snapshot &now, Sequence &phase, Sequence end,
                   double period_s) noexcept {
    constexpr double PASSED = 1e-3;  // part of a cycle's way that is none
    const double way = now.v * period_s;
    const double v2 = now.v * now.v;
    double least = 0;
    double to_piece = -now.x;
    Sequence piece = now.piece;
    for (Sequence n = phase; n < end; ++n) {
        const Phase &p = store.phase(n);
        for (; piece < p.piece; ++piece) {
            to_piece += store.piece(piece).length;
        }
        const double to_end = p.piece < piece ? 0.0 : to_piece + p.x_at(p.duration);
        if (to_end <= PASSED * way) {
            phase = n + 1;
            continue;
        }
        // Where it is no faster at the ends of phases it is not in between, as all squared speeds are linear.
        const double looked = std::min(to_end, way);
        const double planned = p.j == 0 ? squared_speed(p, looked - to_piece) : 0.0;
        least = std::max(least, (v2 - planned) / (2.0 * looked));
        if (to_end >= way) {
            return least;
        }
    }
    return way > 0 ? v2 / (2.0 * way) : 0.0;
}

double brake_within_jerk(const PathStore &store, const Snapshot &now, const Pose &commanded,
                         const StopLimits &limits, const BrakeRange &range, double period_s) noexcept {
    // Who would stand before the cycle is over stands at its end: places are linear in the brake up to there.
    const double least = range.least;
    const double most = std::min(range.most, now.v / period_s);
    if (!(least < most)) {
        return range.most;
    }
    const CommandedPlaces places(store, now, commanded);
    const Pose gentle = places.next(leader_ahead(store, now, least, period_s));
    const Pose hard = places.next(leader_ahead(store, now, most, period_s));
    const Pose before = (places[0] - places[1]) * 3.0 + places[2];
    const double cube = period_s * period_s * period_s;
    const Pose at_least = gentle - before;
    const Pose at_most = hard - before;
    JerkRows rows;
    for (int i = 0; i < AXIS_COUNT; ++i) {
        rows.add(at_least[i], at_most[i], limits.jerk[static_cast<std::size_t>(i)] * cube);
    }
    rows.set_norm(at_least, at_most, limits.jerk[XYZ_NORM] * cube);
    if (limits.map != nullptr) {
        add_joints(rows, places, gentle, hard, limits, cube);
    }
    return least + rows.greatest() * (most - least);
}

}  // namespace mw::trajectory
