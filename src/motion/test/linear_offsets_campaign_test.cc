// SPDX-License-Identifier: GPL-2.0-or-later
// Random machines whose joints move in proportion to axes, with random limits. Programs, jogs, wheels,
// overrides and stops run while pins change the offsets at random times. Motors are checked as joints and as
// axes; without the offsets the motion must match the program; and moves are counted.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/linear_machines.hh"

namespace mw::motion {
namespace linear_offsets_campaign_test {
namespace {

using ::mw::testing::CoordinateLimits;
using ::mw::testing::LinearMachine;
using ::mw::testing::LinearRig;

struct Random {
    std::mt19937 engine;

    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine); }
    bool chance(double p) { return real(0, 1) < p; }
    double power(double low, double high) { return std::pow(10.0, real(low, high)); }
};

CoordinateLimits draw_limits(Random &random, bool isJerkLimited) {
    CoordinateLimits c;
    c.velocity = random.power(1.5, 2.5);
    c.acceleration = random.power(2.5, 3.7);
    c.jerk = isJerkLimited && random.chance(0.8) ? c.acceleration * random.power(1.2, 2.2) : 0;
    return c;
}

/// Matrices near those of a rotated table, or of axes that are not square.
std::array<double, 9> draw_matrix(Random &random) {
    const double turn = random.chance(0.5) ? random.real(-std::numbers::pi, std::numbers::pi) : 0.0;
    const double c = std::cos(turn);
    const double s = std::sin(turn);
    std::array<double, 9> m{c, -s, 0, s, c, 0, 0, 0, 1};
    const double skew = random.chance(0.5) ? 0.3 : 0.01;
    for (double &x : m) {
        x += random.real(-skew, skew);
    }
    return m;
}

enum class Kind { COREXY, MEASURED, TURNED };

/// Half of the machines have joints with less travel than the axes.
LinearMachine draw_machine(Random &random, Kind kind, bool isJerkLimited) {
    LinearMachine m = kind == Kind::COREXY     ? ::mw::testing::corexy()
                      : kind == Kind::MEASURED ? ::mw::testing::measured(draw_matrix(random))
                                               : ::mw::testing::turned_table();
    m.isJerkLimited = isJerkLimited;
    const bool isTight = random.chance(0.5);
    bool hasOffset = false;
    for (int i = 0; i < m.num_joints; ++i) {
        const auto n = static_cast<std::size_t>(i);
        m.axes[n] = draw_limits(random, isJerkLimited);
        m.joints[n] = draw_limits(random, isJerkLimited);
        m.axes[n].low = -random.real(30, 80);
        m.axes[n].high = random.real(30, 80);
        m.joints[n].low = isTight ? -random.real(40, 90) : -300;
        m.joints[n].high = isTight ? random.real(40, 90) : 300;
        m.ratio[n] = random.chance(0.7) ? random.real(0.05, random.chance(0.2) ? 0.9 : 0.5) : 0.0;
        const bool isTurned = kind == Kind::TURNED && (i < 2 || i == geometry::AXIS_C);
        hasOffset = hasOffset || (m.ratio[n] > 0 && !isTurned);
    }
    m.ratio[2] = hasOffset ? m.ratio[2] : 0.3;
    return m;
}

/// X Y Z only, because the tolerances apply to them.
geometry::Pose place_of(const geometry::Pose &p) {
    return {{p[0], p[1], p[2]}};
}

/// Distance from a straight line.
double distance(const geometry::Pose &p, const geometry::Pose &from, const geometry::Pose &to) {
    const geometry::Pose run = to - from;
    const double length2 = geometry::dot(run, run);
    const double t = length2 > 0 ? std::clamp(geometry::dot(p - from, run) / length2, 0.0, 1.0) : 0.0;
    return geometry::norm(p - (from + run * t));
}

struct Way {
    geometry::Pose from, to, centre;
    bool isArc = false;
    double radius = 0, angle = 0, sweep = 0;

    double from_here(const geometry::Pose &p) const {
        if (!isArc) {
            return distance(p, from, to);
        }
        const double x = p[0] - centre[0];
        const double y = p[1] - centre[1];
        // Nearest point on the circle, by angle.
        double turned = std::remainder(std::atan2(y, x) - angle, 2 * std::numbers::pi);
        turned = sweep > 0 && turned < 0 ? turned + 2 * std::numbers::pi : turned;
        turned = sweep < 0 && turned > 0 ? turned - 2 * std::numbers::pi : turned;
        double least = std::min(geometry::norm(p - from), geometry::norm(p - to));
        if (std::abs(turned) <= std::abs(sweep)) {
            geometry::Pose on = from;
            on[0] = centre[0] + radius * std::cos(angle + turned);
            on[1] = centre[1] + radius * std::sin(angle + turned);
            least = std::min(least, geometry::norm(p - on));
        }
        return least;
    }
};

struct Count {
    int sessions = 0, programs = 0, done = 0, moves = 0, refused = 0, jogs = 0, arrived = 0, stopped = 0;
    int asked = 0, reached = 0, limited = 0;
    double v = 0, a = 0, j = 0, outside = -1e300, off_path = -1e300;
};

/// One machine and its actions.
class Session {
  public:
    Session(unsigned seed, bool isJerkLimited, Count &count)
        : random_{std::mt19937(seed)}, count_(count),
          rig_(draw_machine(random_, static_cast<Kind>(seed % 3), isJerkLimited)) {}
    ~Session() {
        rig_.rig->forgive_joints();  // it is judged here
    }
    Session(const Session &) = delete;
    Session &operator=(const Session &) = delete;

    void run() {
        const bool isJogging = random_.chance(0.35);
        isMild_ = random_.chance(0.6);
        rig_.rig->set(Parameter::MAX_FEED_SCALE, 0, 2);
        rig_.begin(isJogging ? Mode::TELEOP : Mode::COORD);
        for (int part = 0; part < 5 && !::testing::Test::HasFailure(); ++part) {
            isJogging ? jog() : drive();
            await_offsets();
        }
        EXPECT_EQ(rig_.report(), "") << rig_.machine.name;
        ++count_.sessions;
        count_.v = std::max({count_.v, rig_.joints->worst_velocity(), rig_.axes->worst_velocity()});
        count_.a = std::max({count_.a, rig_.joints->worst_acceleration(), rig_.axes->worst_acceleration()});
        count_.j = std::max({count_.j, rig_.joints->worst_jerk(), rig_.axes->worst_jerk()});
        count_.outside = std::max(count_.outside, rig_.worst_outside);
        count_.off_path = std::max(count_.off_path, worst_off_path_);
    }

  private:
    /// Changes pins at random times in each cycle.
    void turn_pins() {
        if (!random_.chance(0.02)) {
            return;
        }
        const int axis = random_.whole(0, rig_.machine.num_joints - 1);
        OffsetInput &pin = rig_.pins(axis);
        const double most = isMild_ ? 150 : random_.chance(0.3) ? 4000 : 500;
        pin.counts += static_cast<int>(random_.real(-most, most));
        pin.isEnabled = random_.chance(0.9);
        pin.isClearing = random_.chance(0.1);
    }
    void go(int cycles) {
        for (int n = 0; n < cycles; ++n) {
            turn_pins();
            if (random_.chance(0.002)) {
                rig_.rig->send(SetScale{Scale::FEED, 0, random_.chance(0.2) ? 0.0 : random_.real(0.2, 2)});
                rig_.rig->send(SetScale{Scale::RAPID, 0, random_.real(0.1, 1)});
            }
            rig_.go(1);
            note_path();
        }
    }
    /// The path without offsets lies on the program's path.
    void note_path() {
        if (ways_.empty()) {
            return;
        }
        const geometry::Pose p = place_of(rig_.programmed());
        double least = 1e300;
        for (const Way &way : ways_) {
            least = std::min(least, way.from_here(p));
        }
        worst_off_path_ = std::max(worst_off_path_, least - tolerance_);
        EXPECT_LT(least, tolerance_ + 1e-6) << rig_.machine.name;
    }
    geometry::Pose draw_place(double share) {
        geometry::Pose p = end_;
        for (int i = 0; i < rig_.machine.num_joints; ++i) {
            const CoordinateLimits &axis = rig_.machine.axes[static_cast<std::size_t>(i)];
            p[i] = random_.chance(0.8) ? random_.real(share * axis.low, share * axis.high) : p[i];
        }
        return p;
    }
    MoveTerms draw_terms() {
        MoveTerms terms;
        terms.isRapid = random_.chance(0.3);
        terms.feed = terms.isRapid ? 0 : random_.power(1, 2.5);
        terms.mode = tolerance_ > 0 ? PathMode::BLEND : PathMode::EXACT_PATH;
        terms.tolerance = tolerance_;
        terms.source.line = static_cast<std::int32_t>(ways_.size()) + 1;
        return terms;
    }
    CommandId send_line(double share) {
        Line line;
        line.end = draw_place(share);
        line.terms = draw_terms();
        ways_.push_back({place_of(end_), place_of(line.end), {}});
        end_ = line.end;
        return rig_.rig->send_path(line);
    }
    CommandId send_arc() {
        Way way;
        way.isArc = true;
        way.from = way.to = way.centre = place_of(end_);
        way.radius = random_.real(2, 12);
        way.angle = random_.real(-3, 3);
        way.sweep = random_.real(0.5, 6) * (random_.chance(0.5) ? 1 : -1);
        way.centre[0] -= way.radius * std::cos(way.angle);
        way.centre[1] -= way.radius * std::sin(way.angle);
        way.to[0] = way.centre[0] + way.radius * std::cos(way.angle + way.sweep);
        way.to[1] = way.centre[1] + way.radius * std::sin(way.angle + way.sweep);
        Arc arc;
        arc.end = end_;
        arc.end[0] = way.to[0];
        arc.end[1] = way.to[1];
        arc.centre = way.centre;
        arc.normal[2] = 1;
        arc.angle_rad = way.sweep;
        arc.terms = draw_terms();
        arc.terms.isRapid = false;
        arc.terms.feed = std::max(arc.terms.feed, 10.0);
        ways_.push_back(way);
        end_ = arc.end;
        return rig_.rig->send_path(arc);
    }
    void drive() {
        end_ = rig_.rig->status().carte_pos_cmd;
        for (int i = 0; i < rig_.machine.num_joints; ++i) {
            end_[i] -= rig_.rig->status().axis[static_cast<std::size_t>(i)].external_offset;
        }
        ways_.clear();
        tolerance_ = random_.chance(0.6) ? random_.real(0.01, 1.5) : 0.0;
        ways_.push_back({place_of(end_), place_of(end_), {}});
        const double share = random_.chance(0.5) ? 0.5 : 0.95;
        for (int n = 0; n < 8; ++n) {
            random_.chance(0.25) ? send_arc() : send_line(share);
            ++count_.moves;
        }
        const CommandId id = rig_.rig->send_path(Flush{});
        ++count_.programs;
        const bool isAborted = random_.chance(0.25);
        const int most = isAborted ? random_.whole(50, 4000) : 400000;
        for (int n = 0; n < most && rig_.rig->answer_to(id) == nullptr; ++n) {
            go(1);
            if (random_.chance(0.001)) {
                rig_.rig->send(Pause{});
                go(random_.whole(1, 300));
                rig_.rig->send(Resume{});
            }
        }
        int refused = 0;
        for (const Answer &answer : rig_.rig->answers) {
            const bool isRefused = answer.kind == AnswerKind::REFUSED;
            refused += isRefused ? 1 : 0;
            EXPECT_TRUE(!isRefused || answer.reason == Reason::BEYOND_SOFT_LIMIT ||
                        answer.reason == Reason::JOINT_BEYOND_LIMIT)
                << static_cast<int>(answer.reason);
        }
        count_.refused += refused;
        count_.done += rig_.rig->isDone(id) ? 1 : 0;
        EXPECT_TRUE(isAborted || refused > 0 || rig_.rig->isDone(id)) << "the program does not end";
        ways_.clear();  // a stop may end on an arc
        rig_.rig->send(Abort{++rig_.rig->epoch});
        go(1500);
        rig_.rig->answers.clear();
        expect_no_fault(false);
    }
    void expect_no_fault(bool areStopsAllowed) {
        for (const Fault &fault : rig_.rig->faults) {
            EXPECT_TRUE(areStopsAllowed && fault.kind == FaultKind::JOG_JOINT_LIMIT)
                << static_cast<int>(fault.kind);
        }
        rig_.rig->faults.clear();
    }
    void jog() {
        const int axes = random_.whole(1, 2);
        std::array<int, 2> axis{};
        std::array<double, 2> target{};
        for (int n = 0; n < axes; ++n) {
            const auto k = static_cast<std::size_t>(n);
            axis[k] = random_.whole(0, rig_.machine.num_joints - 1);
            const CoordinateLimits &limits = rig_.machine.axes[static_cast<std::size_t>(axis[k])];
            const double v = random_.power(1, 2.5);
            if (random_.chance(0.3)) {
                rig_.rig->send(JogContinuous{{false, axis[k]}, random_.chance(0.5) ? v : -v});
                target[k] = 1e300;
            } else {
                target[k] = random_.real(0.7 * limits.low, 0.7 * limits.high);
                rig_.rig->send(JogAbsolute{{false, axis[k]}, v, target[k]});
            }
            go(random_.whole(1, 400));
        }
        const bool isWheel = random_.chance(0.3);
        for (int n = 0; n < 20 && isWheel; ++n) {
            WheelInput &wheel = rig_.rig->in.axis_wheel[0];
            wheel.isEnabled = true;
            wheel.scale = 0.05;
            wheel.counts += random_.whole(-20, 20);
            go(random_.whole(1, 60));
        }
        rig_.rig->in.axis_wheel[0].isEnabled = false;
        rig_.rig->send(SetScale{Scale::FEED, 0, 1});
        go(random_.whole(500, 6000));
        const bool isStopped = !rig_.rig->faults.empty();
        bool isRefused = false;
        for (const Answer &answer : rig_.rig->answers) {
            isRefused = isRefused || answer.kind == AnswerKind::REFUSED;
        }
        rig_.rig->answers.clear();
        for (int n = 0; n < axes; ++n) {
            const auto k = static_cast<std::size_t>(n);
            const bool isOther = axes == 2 && axis[0] == axis[1] && n == 0;
            if (target[k] >= 1e300 || isOther || (isWheel && axis[k] == 0)) {
                continue;
            }
            ++count_.jogs;
            count_.stopped += isStopped || isRefused ? 1 : 0;
            for (int left = 60000; left > 0 && rig_.rig->out->isJogging; --left) {
                go(1);
            }
            const bool isThere = std::abs(rig_.shown(axis[k]) - target[k]) < 1e-9;
            count_.arrived += isThere ? 1 : 0;
            EXPECT_TRUE(isThere || isStopped || isRefused || !rig_.rig->faults.empty())
                << "axis " << axis[k] << " stands at " << rig_.shown(axis[k]) << ", sent to " << target[k];
        }
        rig_.rig->send(SetTeleopVector{});
        go(1500);
        expect_no_fault(true);
    }
    /// Waits while nothing else moves, until offsets reach their request or are reported as limited.
    void await_offsets() {
        constexpr int LONG = 600000;  // of the smallest share
        bool isFar = true;
        int limited = 0;
        for (int n = 0; n < LONG && isFar && limited < 5000; ++n) {
            rig_.go(1);
            limited = rig_.rig->out->isOffsetLimited ? limited + 1 : 0;
            isFar = false;
            for (int i = 0; i < rig_.machine.num_joints; ++i) {
                isFar = isFar || std::abs(rig_.offset(i) - rig_.request(i)) > 1e-9;
            }
        }
        ++count_.asked;
        count_.reached += isFar ? 0 : 1;
        count_.limited += isFar && rig_.rig->out->isOffsetLimited ? 1 : 0;
        EXPECT_TRUE(!isFar || rig_.rig->out->isOffsetLimited) << rig_.machine.name;
    }

    Random random_;
    Count &count_;
    LinearRig rig_;
    std::vector<Way> ways_;
    geometry::Pose end_;
    double tolerance_ = 0;
    double worst_off_path_ = -1e300;  ///< over the tolerance
    bool isMild_ = false;             ///< most limits are larger than the offsets need
};

class LinearOffsetCampaign : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutJerk, LinearOffsetCampaign, ::testing::Bool());

TEST_P(LinearOffsetCampaign, NoSampleOfTheSumExceedsALimitOfJointsOrAxes) {
    const char *wanted = std::getenv("MW_OFFSET_SESSIONS");
    const int sessions = wanted != nullptr ? std::atoi(wanted) : 18;
    const char *first = std::getenv("MW_OFFSET_FIRST");
    const unsigned begin = first != nullptr ? static_cast<unsigned>(std::atoi(first)) : 1U;
    Count count;
    for (unsigned seed = begin; seed < begin + static_cast<unsigned>(sessions); ++seed) {
        SCOPED_TRACE(seed);
        Session session(seed, GetParam(), count);
        session.run();
        if (::testing::Test::HasFailure()) {
            return;
        }
    }
    std::printf("linear offsets: %d sessions, %d of %d programs done, %d of %d moves rejected, %d of %d jogs "
                "arrived (%d stopped), offsets %d reached %d limited of %d\n"
                "worst: velocity %.6f acceleration %.6f jerk %.6f of the limits, %.2e outside, %.2e off the "
                "path over the tolerance\n",
                count.sessions, count.done, count.programs, count.refused, count.moves, count.arrived,
                count.jogs, count.stopped, count.reached, count.limited, count.asked, count.v, count.a,
                count.j, count.outside, count.off_path);
    EXPECT_EQ(count.reached + count.limited, count.asked);
    EXPECT_GT(count.done, count.programs / 4);
    EXPECT_GT(count.refused, 0);
    EXPECT_GT(count.arrived, count.jogs / 3);
    EXPECT_GT(count.reached, count.asked / 3);
    EXPECT_GT(count.limited, 0);
}

}  // namespace
}  // namespace linear_offsets_campaign_test
}  // namespace mw::motion
