// SPDX-License-Identifier: GPL-2.0-or-later
// A machine with a spindle that has inertia and an encoder, and a judge of how the tool keeps to it. The
// judge looks at the rotor's true angle at the instant at which the commanded position is due; it shares
// nothing with what motion reckons from the encoder.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "sim/spindle_plant.hh"
#include "testing/motion_rig.hh"

namespace mw::motion {

struct SpindleBench {
    static constexpr double T = testing::MotionRig::T;
    static constexpr double VELOCITY = 150, ACCELERATION = 1200, JERK = 24000;

    struct Sample {
        double x = 0, z = 0;
        double turns = 0, speed = 0;  ///< of the rotor: the truth
        double command_rpm = 0;
    };

    testing::MotionRig rig{"XYZ", VELOCITY, ACCELERATION};
    sim::SpindlePlant plant;
    std::function<double(const Sample &)> load = [](const Sample &) { return 0.0; };
    bool isDriveDead = false;  ///< the drive keeps to what it was told last
    std::vector<Sample> samples;

    explicit SpindleBench(const sim::SpindleTraits &traits, bool isJerkLimited = false) : plant(traits) {
        if (isJerkLimited) {
            rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig.set(Parameter::TRAJ_MAX_JERK, 0, JERK);
            for (int j = 0; j < 3; ++j) {
                rig.set(Parameter::JOINT_MAX_JERK, j, JERK);
            }
        }
        jerk_ = isJerkLimited ? JERK : 1e300;
        rig.ready();
        rig.before_step = [this](testing::MotionRig &r) { turn(r); };
        rig.step(20);
    }

    /// Stops with the report of whatever the axes did beyond their limits since the last call.
    std::string limit_report() {
        const testing::AxisLimit limit{VELOCITY, ACCELERATION, jerk_};
        testing::LimitChecker checker({limit, limit}, T);
        for (const Sample &s : samples) {
            const double axes[] = {s.x, s.z};
            checker.sample(axes);
        }
        return checker.report();
    }
    void spin(double rpm) {
        rig.send(SpindleOn{0, rpm});
        rig.step(5);
        rig.run_until([this] { return rig.in.spindle[0].isAtSpeed; });
    }
    CommandId rapid(double x, double z) {
        geom::Pose end;
        end[geom::AXIS_X] = x;
        end[geom::AXIS_Z] = z;
        return rig.line(end, 0, PathMode::EXACT_STOP);
    }
    MoveTerms synched(double lead) {
        MoveTerms terms;
        terms.mode = PathMode::BLEND;
        terms.feed_per_revolution = lead;
        terms.source.line = static_cast<std::int32_t>(rig.next_id);
        terms.source.block = static_cast<std::uint32_t>(rig.next_id);
        return terms;
    }
    CommandId thread(double x, double z, double lead) {
        Line line;
        line.end[geom::AXIS_X] = x;
        line.end[geom::AXIS_Z] = z;
        line.terms = synched(lead);
        return rig.send_path(line);
    }
    CommandId tap(double x, double z, double pitch, double scale = 1) {
        RigidTap move;
        move.end[geom::AXIS_X] = x;
        move.end[geom::AXIS_Z] = z;
        move.pitch_scale = scale;
        move.terms = synched(pitch);
        return rig.send_path(move);
    }
    bool finish(double max_s = 60) {
        const CommandId end = rig.send_path(Flush{});
        const bool isDone =
            rig.run_until([&] { return rig.answer_to(end) != nullptr; }, max_s) && rig.isDone(end);
        rig.step(3);  // a sample is complete in the cycle after
        return isDone;
    }

  private:
    void turn(testing::MotionRig &r) {
        command_ = isDriveDead ? command_ : r.out->spindle[0].speed_rpm / 60.0;
        plant.run(command_, samples.empty() ? 0.0 : load(samples.back()), T);
        if (r.cycle > 1) {
            const double x = r.out->joint[0].motor_pos_cmd, z = r.out->joint[2].motor_pos_cmd;
            samples.push_back({x, z, plant.turns(), plant.speed(), r.out->spindle[0].speed_rpm});
        }
        // The speed as an encoder counter tells it: counts over the last eight periods.
        constexpr std::size_t WINDOW = 8;
        shown_.push_back(plant.shown_turns());
        const std::size_t back = std::min(WINDOW, shown_.size() - 1);
        const double rps =
            back > 0 ? (shown_.back() - shown_[shown_.size() - 1 - back]) / (static_cast<double>(back) * T)
                     : 0;
        SpindleInputs &in = r.in.spindle[0];
        in.revs = shown_.back();
        in.speed_in_rps = rps;
        const double wanted = r.out->spindle[0].speed_rpm / 60.0;
        in.isAtSpeed = std::abs(rps - wanted) <= 0.02 * std::abs(wanted) + 0.05;
    }

    double jerk_ = 1e300;
    double command_ = 0;
    std::vector<double> shown_;
};

/// Of a stretch of samples cut along Z with a lead: where its helix passes Z 0, and how far it leaves it.
struct Helix {
    double phase = 0;     ///< turn of the rotor at Z 0, the median [turns]
    double farthest = 0;  ///< from it [turns]
};
/// Z falls by `lead` a turn. `from`, `to`: samples.
inline Helix helix_of(const std::vector<SpindleBench::Sample> &samples, std::size_t from, std::size_t to,
                      double lead) {
    std::vector<double> phases;
    for (std::size_t i = from; i < to; ++i) {
        phases.push_back(samples[i].z / lead + samples[i].turns);
    }
    std::vector<double> sorted = phases;
    std::sort(sorted.begin(), sorted.end());
    Helix out;
    out.phase = sorted.empty() ? NAN : sorted[sorted.size() / 2];
    for (const double p : phases) {
        out.farthest = std::max(out.farthest, std::abs(p - out.phase));
    }
    return out;
}

}  // namespace mw::motion
