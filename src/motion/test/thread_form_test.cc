// SPDX-License-Identifier: GPL-2.0-or-later
// Form of threads and taps by the whole of motion with a torque model of the spindle, which is independent of
// the follower. Checked by the true angle of the rotor. docs/integrator/spindles.md contains the printed
// figures.
#include <cstdio>

#include <gtest/gtest.h>

#include "components/plants/driven_spindle.hh"
#include "spindle_bench.hh"

namespace mw::motion {
namespace {

constexpr double T = testing::MotionRig::T, FORM_LEAD = 1.5, FORM_START = 5, FORM_END = -30;
constexpr double FORM_DEGREES = 360;

struct FormBench {
    struct Sample {
        double z = 0, angle = 0, speed = 0, command = 0;
    };
    testing::MotionRig rig{"XYZ", SpindleBench::VELOCITY, SpindleBench::ACCELERATION};
    plants::DrivenSpindle spindle;
    double cut = 0;  ///< torque of the cut below Z 0, which increases within a revolution
    std::vector<double> shown;
    std::vector<Sample> samples;

    FormBench(const plants::DrivenSpindleTraits &traits, bool isJerkLimited) : spindle(traits) {
        if (isJerkLimited) {
            rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig.set(Parameter::TRAJ_MAX_JERK, 0, SpindleBench::JERK);
            for (int j = 0; j < 3; ++j) {
                rig.set(Parameter::JOINT_MAX_JERK, j, SpindleBench::JERK);
            }
        }
        rig.ready();
        rig.before_step = [this](testing::MotionRig &r) { turn(r); };
        rig.step(20);
    }
    void spin(double rpm) {
        rig.send(SpindleOn{0, rpm});
        rig.step(1500);
        rig.run_until([this] { return rig.in.spindle[0].isAtSpeed; });
    }
    bool finish() {
        const CommandId end = rig.send_path(Flush{});
        const bool isDone =
            rig.run_until([&] { return rig.answer_to(end) != nullptr; }, 60) && rig.isDone(end);
        rig.step(3);
        return isDone;
    }
    MoveTerms synched(double lead) const {
        MoveTerms terms;
        terms.mode = PathMode::BLEND;
        terms.feed_per_revolution = lead;
        return terms;
    }
    void rapid(double x, double z) {
        geometry::Pose end;
        end[geometry::AXIS_X] = x;
        end[geometry::AXIS_Z] = z;
        rig.line(end, 0, PathMode::EXACT_STOP);
        EXPECT_TRUE(finish());
    }
    /// A pass like that of G76. Returns the samples between `from` and `to` in Z.
    std::vector<Sample> pass(double x, double torque, double from, double to) {
        rapid(x, FORM_START);
        samples.clear();
        cut = torque;
        Line line;
        line.end[geometry::AXIS_X] = x;
        line.end[geometry::AXIS_Z] = FORM_END;
        line.terms = synched(FORM_LEAD);
        rig.send_path(line);
        EXPECT_TRUE(finish());
        cut = 0;
        std::vector<Sample> within;
        std::copy_if(samples.begin(), samples.end(), std::back_inserter(within),
                     [&](const Sample &s) { return s.z <= from && s.z >= to; });
        rapid(14, FORM_END);
        rapid(14, FORM_START);
        return within;
    }
    bool tap(double x, double pitch) {
        rapid(x, FORM_START);
        samples.clear();
        cut = 15;
        RigidTap move;
        move.end[geometry::AXIS_X] = x;
        move.end[geometry::AXIS_Z] = BOTTOM;
        move.terms = synched(pitch);
        rig.send_path(move);
        const bool isMade = finish();
        cut = 0;
        return isMade;
    }

  private:
    void turn(testing::MotionRig &r) {
        const double z = r.out->joint[2].motor_pos_cmd;
        spindle.run(r.out->spindle[0].speed_rpm / 60, cut * std::clamp(-z / FORM_LEAD, 0.0, 1.0), T);
        samples.push_back({z, spindle.angle(), spindle.speed(), r.out->spindle[0].speed_rpm});
        shown.push_back(spindle.shown());
        constexpr std::size_t WINDOW = 100;
        const std::size_t back = std::min(WINDOW, shown.size() - 1);
        const double rps =
            back > 0 ? (shown.back() - shown[shown.size() - 1 - back]) / (static_cast<double>(back) * T) : 0;
        SpindleInputs &in = r.in.spindle[0];
        in.revs = shown.back();
        in.speed_in_rps = rps;
        in.isAtSpeed = std::abs(rps * 60 - r.out->spindle[0].speed_rpm) < 0.1 * std::abs(rps) * 60 + 5;
    }
};

struct Extent {
    double low = INFINITY, high = -INFINITY;
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
    double width() const { return high - low; }
};

double phase_of(const FormBench::Sample &s, double pitch) {
    return s.angle + s.z / pitch;
}

struct Form {
    double scatter_deg = 0;  ///< of the start angles of all passes and speeds, before the cut
    double form_deg = 0;     ///< maximum deviation from the start angle within a pass, with the cut
};

Form thread_form(const plants::DrivenSpindleTraits &traits, bool isJerkLimited) {
    FormBench bench(traits, isJerkLimited);
    Extent starts;
    double base = NAN;
    Form out;
    for (const double rpm : {180.0, 700.0, 1500.0}) {
        bench.spin(rpm);
        for (int n = 0; n < 4; ++n) {
            bench.rig.step(31 + 17 * n);
            const auto all = bench.pass(10 - 0.1 * n, 6.0 * n, -8, FORM_END + 8);
            if (all.empty()) {
                ADD_FAILURE() << "no samples";
                continue;
            }
            Extent within;
            double sum = 0;
            for (const auto &s : all) {
                within.add(phase_of(s, FORM_LEAD));
                sum += phase_of(s, FORM_LEAD);
            }
            const double mean = sum / static_cast<double>(all.size());
            base = std::isnan(base) ? mean : base;
            starts.add(std::remainder(mean - base, 1.0));
            out.form_deg =
                std::max(out.form_deg, FORM_DEGREES * std::max(within.high - mean, mean - within.low));
        }
    }
    out.scatter_deg = FORM_DEGREES * starts.width();
    return out;
}

struct Taps {
    double off = 0;          ///< from the helix through the reversal at the bottom [rev]
    double first = 0;        ///< error of the bottom of the first hole [rev]
    double other_speed = 0;  ///< maximum of a first hole at another speed [rev]
    double same_speed = 0;   ///< maximum of later holes [rev]
    int made = 0;
};

Taps tap_form(const plants::DrivenSpindleTraits &traits, bool isJerkLimited) {
    FormBench bench(traits, isJerkLimited);
    Taps out;
    int hole = 0;
    for (const double rpm : {250.0, 1200.0, 500.0}) {
        bench.spin(rpm);
        for (int n = 0; n < 3; ++n, ++hole) {
            bench.rig.step(53 * n);
            out.made += bench.tap(10, PITCH) ? 1 : 0;
            double bottom = 0;
            std::vector<double> phases;
            for (const auto &s : bench.samples) {
                bottom = std::min(bottom, s.z);
                if (s.z < -6) {
                    phases.push_back(phase_of(s, PITCH));
                }
            }
            if (phases.empty()) {
                continue;
            }
            double mean = 0;
            const std::size_t count = std::min<std::size_t>(100, phases.size());
            for (std::size_t i = 0; i < count; ++i) {
                mean += phases[i] / static_cast<double>(count);
            }
            for (const double p : phases) {
                out.off = std::max(out.off, std::abs(p - mean));
            }
            const double error = std::abs(bottom - BOTTOM) / PITCH;
            double &where = hole == 0 ? out.first : n == 0 ? out.other_speed : out.same_speed;
            where = std::max(where, error);
        }
    }
    return out;
}

class ThreadForm : public ::testing::TestWithParam<bool> {};

plants::DrivenSpindleTraits with_encoder(int counts) {
    plants::DrivenSpindleTraits traits;
    traits.counts = counts;
    return traits;
}

TEST_P(ThreadForm, IsKeptWithAnyEncoder) {
    for (const int counts : {20, 60, 200, 1000, 4096, 10000}) {
        const Form form = thread_form(with_encoder(counts), GetParam());
        std::printf("thread%s | %d | %.2f | %.2f\n", GetParam() ? ", jerk limits" : "", counts,
                    form.scatter_deg, form.form_deg);
    }
}

TEST_P(ThreadForm, OfTapsIsKeptWithAnyEncoder) {
    for (const int counts : {60, 200, 1000, 4096, 10000}) {
        const Taps taps = tap_form(with_encoder(counts), GetParam());
        std::printf("tap%s | %d | %.4f | %.3f | %.3f | %.3f | %d\n", GetParam() ? ", jerk limits" : "",
                    counts, taps.off, taps.first, taps.other_speed, taps.same_speed, taps.made);
    }
}

INSTANTIATE_TEST_SUITE_P(Planners, ThreadForm, ::testing::Bool(),
                         [](const auto &which) { return which.param ? "JerkLimited" : "Trapezoidal"; });

}  // namespace
}  // namespace mw::motion
