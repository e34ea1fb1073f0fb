// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/planner/reach_check.hh"

#include <bit>
#include <cmath>

#include "trajectory/tuning.hh"

namespace mw::motion {

namespace {

constexpr double SOFT_LIMIT_ROUNDING = 1e-6;
/// An axis that moves by less is treated as stopped [machine units, degrees].
constexpr double LEAST_WAY = 1e-9;

/// Remaining travel of a line from its end, or from its start with the sense -1, to a soft limit.
TravelToLimit travel_to_soft_limit(const trajectory::Primitive &line, double sense,
                                   const PathLimits &limits) noexcept {
    const geometry::Pose &end = sense > 0 ? line.end : line.start;
    TravelToLimit room;
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const double slope = sense * line.lin[i];
        if (slope == 0) {
            continue;
        }
        const double limit = slope > 0 ? limits.high[i] : limits.low[i];
        const double way = (limit - end[i]) / slope;
        if (way < room.way) {
            room = {way, i, -1};
        }
    }
    return room;
}

/// Travel of joints that external offsets also move; 0 for other joints.
JointRange shared_extent(const trajectory::Primitive &p, const SharedJoints &shared) noexcept {
    JointRange out;
    for (std::uint32_t left = shared.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        trajectory::extent_along(p, shared.slope[j], out.low[j], out.high[j]);
    }
    return out;
}

}  // namespace

bool ReachCheck::follow(const Seqlock<PathLimits> &limits) noexcept {
    constexpr int TRIES = 1000;
    if (!limits.read(limits_, TRIES)) {
        return false;
    }
    if (limits_.position_changes != position_changes_) {
        position_changes_ = limits_.position_changes;
        end_joints_ = limits_.start_joints;
        map_.stand_at(limits_.start_joints, limits_.side);
    }
    return true;
}

TravelRange ReachCheck::extent(const trajectory::Primitive &p) const noexcept {
    TravelRange range;
    trajectory::extent(p, range.axes.low, range.axes.high);
    range.joints = shared_extent(p, limits_.shared);
    return range;
}

Refusal ReachCheck::check(const trajectory::Primitive &p, const TravelRange &move, const TravelRange &room,
                          int indexer) noexcept {
    Refusal refusal = check_axes(p, move.axes, room.axes, indexer);
    if (refusal.reason == Reason::NONE && isMapped()) {
        refusal = check_joints(p, room.joints);
    }
    return refusal.reason == Reason::NONE ? check_shared(p, move.joints, room.joints) : refusal;
}

Refusal ReachCheck::check_axes(const trajectory::Primitive &p, const PoseRange &move, const PoseRange &room,
                               int indexer) const noexcept {
    for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
        const auto index = static_cast<std::int16_t>(i);
        const bool isMoving = move.high[i] - move.low[i] > LEAST_WAY;
        if (isMoving && (limits_.axes & (1U << i)) == 0) {
            return {Reason::NO_SUCH_AXIS, index};
        }
        const int lock = limits_.indexer[static_cast<std::size_t>(i)];
        if (isMoving && lock >= 0 && lock != indexer) {
            return {Reason::INDEXER_ALONE, index};
        }
        // A move from outside the limits is accepted if it ends inside.
        const double from = p.start[i];
        const bool isLow = move.low[i] < std::min(room.low[i], from) - SOFT_LIMIT_ROUNDING ||
                           p.end[i] < room.low[i] - SOFT_LIMIT_ROUNDING;
        const bool isHigh = move.high[i] > std::max(room.high[i], from) + SOFT_LIMIT_ROUNDING ||
                            p.end[i] > room.high[i] + SOFT_LIMIT_ROUNDING;
        if (isMoving && (isLow || isHigh)) {
            return {Reason::BEYOND_SOFT_LIMIT, index};
        }
    }
    return {};
}

/// On an arc a joint can exceed the positions sampled by check_joints(). Shared joints are checked exactly.
Refusal ReachCheck::check_shared(const trajectory::Primitive &p, const JointRange &move,
                                 const JointRange &room) const noexcept {
    const JointRange start = limits_.shared.at(p.start);
    for (std::uint32_t left = limits_.shared.joints; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        const bool isOut = move.low[j] < std::min(room.low[j], start.low[j]) - SOFT_LIMIT_ROUNDING ||
                           move.high[j] > std::max(room.high[j], start.high[j]) + SOFT_LIMIT_ROUNDING;
        if (isOut) {
            return {Reason::JOINT_BEYOND_LIMIT, static_cast<std::int16_t>(j)};
        }
    }
    return {};
}

/// True if the joints can move from one point of the path to the next. Halves the distance until the joints
/// change little, or until they would have to move so fast that the path would crawl. Joints that jump at a
/// singular pose do so at any distance.
bool ReachCheck::isSteady(const trajectory::Primitive &p, PathSample from, PathSample to) const noexcept {
    constexpr double MUCH = 30;  // [machine units, degrees]
    constexpr double LITTLE = 1;
    constexpr double SLOWEST = 0.005;  // as a fraction of the speed of the machine
    constexpr int HALVINGS = 40;
    const double wish = limits_.limits.velocity.back();
    const double slowest = wish < trajectory::UNLIMITED ? SLOWEST * wish : 0.0;
    const auto change = [&](const PathSample &a, const PathSample &b) {
        double most = 0;
        for (std::size_t j = 0; j < static_cast<std::size_t>(num_joints_); ++j) {
            most = std::max(most, std::abs(b.joints[j] - a.joints[j]));
        }
        return most;
    };
    const auto isCrawling = [&](const PathSample &a, const PathSample &b) {
        bool isSlow = false;
        for (std::size_t j = 0; j < static_cast<std::size_t>(num_joints_); ++j) {
            const double step = std::abs(b.joints[j] - a.joints[j]);
            isSlow = isSlow || (step > LITTLE && limits_.joints.velocity[j] * (b.at - a.at) < step * slowest);
        }
        return isSlow;
    };
    bool isMuch = change(from, to) > MUCH;
    for (int n = 0; n < HALVINGS && isMuch && !isCrawling(from, to); ++n) {
        PathSample middle{0.5 * (from.at + to.at), from.joints};
        if (map_.find(trajectory::position_at(p, middle.at), middle.joints.data()) !=
            kinematics::Status::OK) {
            return false;
        }
        (change(from, middle) > change(middle, to) ? to : from) = middle;
        isMuch = change(from, to) > LITTLE;
    }
    return !isMuch && !isCrawling(from, to);
}

Refusal ReachCheck::check_joints(const trajectory::Primitive &p, const JointRange &room) noexcept {
    // Sufficient for an angle on a circle not to change by half a revolution between samples.
    constexpr int LEAST_SAMPLES = 64;
    constexpr double SAMPLES_PER_RAD = 1.5;
    constexpr double MOST_SAMPLES = 20000;
    const double sweep = std::abs(p.omega) * p.length;
    const int samples =
        std::max(LEAST_SAMPLES, static_cast<int>(std::min(sweep * SAMPLES_PER_RAD, MOST_SAMPLES)));
    PathSample last{0, end_joints_};
    Joints begin{};
    for (int n = 0; n <= samples; ++n) {
        PathSample here{p.length * n / samples, last.joints};
        const kinematics::Status status = map_.find(trajectory::position_at(p, here.at), here.joints.data());
        if (status == kinematics::Status::UNREACHABLE) {
            return {Reason::UNREACHABLE};
        }
        if (status == kinematics::Status::SINGULAR || (n > 0 && !isSteady(p, last, here))) {
            return {Reason::SINGULAR};
        }
        begin = n == 0 ? here.joints : begin;
        const bool isOnTheWay = n < samples;
        for (int j = 0; j < num_joints_; ++j) {
            const auto i = static_cast<std::size_t>(j);
            // A joint outside its limit, for instance after its drive was off, may move back but not further
            // out.
            const double low = isOnTheWay ? std::min(room.low[i], begin[i]) : room.low[i];
            const double high = isOnTheWay ? std::max(room.high[i], begin[i]) : room.high[i];
            if (here.joints[i] < low - SOFT_LIMIT_ROUNDING || here.joints[i] > high + SOFT_LIMIT_ROUNDING) {
                return {Reason::JOINT_BEYOND_LIMIT, static_cast<std::int16_t>(j)};
            }
        }
        last = here;
    }
    end_joints_ = last.joints;
    return {};
}

TravelToLimit ReachCheck::travel_past(const trajectory::Primitive &line, double sense, const Joints &joints,
                                      double turn) const noexcept {
    const TravelToLimit axes = travel_to_soft_limit(line, sense, limits_);
    return kinematics_.identity() == nullptr ? limit_by_joints(line, sense, axes, joints, turn) : axes;
}

/// The travel past an end of a line that the joints can follow. `joints`: their positions at that end;
/// `turn`: travel per spindle revolution.
TravelToLimit ReachCheck::limit_by_joints(const trajectory::Primitive &line, double sense,
                                          const TravelToLimit &axes, const Joints &joints,
                                          double turn) const noexcept {
    constexpr int SAMPLES = 100;
    const geometry::Pose &end = sense > 0 ? line.end : line.start;
    TravelToLimit room = axes;
    const double most = trajectory::TapTuning::MOST_ROOM * turn;
    room.way = std::min(room.way, most);
    const trajectory::Primitive on = trajectory::make_line(end, end + line.lin * (sense * most));
    PathSample last{0, joints};
    for (int n = 1; n <= SAMPLES && last.at < room.way; ++n) {
        PathSample here{on.length * n / SAMPLES, last.joints};
        const bool isFound =
            map_.find(trajectory::position_at(on, here.at), here.joints.data()) == kinematics::Status::OK;
        int stopped = isFound && isSteady(on, last, here) ? -1 : MAX_JOINTS;
        for (int j = 0; j < num_joints_ && stopped < 0; ++j) {
            const auto i = static_cast<std::size_t>(j);
            const bool isOut =
                here.joints[i] < limits_.joints.low[i] || here.joints[i] > limits_.joints.high[i];
            stopped = isOut ? j : stopped;
        }
        if (stopped >= 0) {
            return {last.at - trajectory::TapTuning::ROOM_MARGIN, -1, stopped};
        }
        last = here;
    }
    return room;
}

}  // namespace mw::motion
