// SPDX-License-Identifier: GPL-2.0-or-later
// A machine with a spindle that has inertia and an encoder, and a judge of the synchronisation of the tool.
// The judge evaluates the rotor's true angle at the time of the commanded position; it does not use values
// that motion calculates from the encoder.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "components/plants/spindle_plant.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {

struct SpindleBench {
    static constexpr double T = testing::MotionRig::T;
    static constexpr double VELOCITY = 150, ACCELERATION = 1200, JERK = 24000;

    struct Sample {
        double x = 0, z = 0;
        double turns = 0, speed = 0;  ///< true values of the rotor
        double command_rpm = 0;
        std::array<double, MAX_JOINTS> joints{};
        geometry::Pose pose;  ///< of a machine whose joints are not axes
    };

    testing::MotionRig rig;
    plants::SpindlePlant plant;
    const kinematics::Kinematics *model = nullptr;  ///< null: joints are X Y Z
    geometry::Pose base;                            ///< zero of X and Z of moves and samples
    std::function<double(const Sample &)> load = [](const Sample &) { return 0.0; };
    bool isDriveDead = false;  ///< the drive keeps its last command
    std::vector<Sample> samples;

    explicit SpindleBench(const plants::SpindleTraits &traits, bool isJerkLimited = false)
        : rig("XYZ", VELOCITY, ACCELERATION), plant(traits) {
        begin(isJerkLimited);
    }
    /// A machine whose joints are not axes; `start` sets the joint positions.
    SpindleBench(const kinematics::Kinematics &kinematics, const std::vector<double> &start,
                 const plants::SpindleTraits &traits, bool isJerkLimited)
        : rig(kinematics, static_cast<int>(start.size()), VELOCITY, ACCELERATION), plant(traits),
          model(&kinematics), num_joints_(static_cast<int>(start.size())) {
        for (std::size_t j = 0; j < start.size(); ++j) {
            rig.in.joint[j].motor_pos_fb = start[j];
            rig.set(Parameter::JOINT_HOME, static_cast<int>(j), start[j]);
            rig.set(Parameter::JOINT_HOME_OFFSET, static_cast<int>(j), start[j]);
        }
        rig.step(4);
        begin(isJerkLimited);
        base = rig.status().carte_pos_cmd;
    }

    /// Lists joints that exceeded their limits.
    std::string limit_report() {
        const testing::AxisLimit limit{VELOCITY, ACCELERATION, jerk_};
        testing::LimitChecker checker(
            std::vector<testing::AxisLimit>(static_cast<std::size_t>(num_joints_), limit), T);
        for (const Sample &s : samples) {
            checker.sample(s.joints.data());
        }
        return checker.report();
    }
    void spin(double rpm) {
        rig.send(SpindleOn{0, rpm});
        rig.step(5);
        rig.run_until([this] { return rig.in.spindle[0].isAtSpeed; });
    }
    CommandId rapid(double x, double z) {
        geometry::Pose end = base;
        end[geometry::AXIS_X] += x;
        end[geometry::AXIS_Z] += z;
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
        line.end[geometry::AXIS_X] = x;
        line.end[geometry::AXIS_Z] = z;
        line.terms = synched(lead);
        return rig.send_path(line);
    }
    CommandId tap(double x, double z, double pitch, double scale = 1) {
        RigidTap move;
        move.end = base;
        move.end[geometry::AXIS_X] += x;
        move.end[geometry::AXIS_Z] += z;
        move.pitch_scale = scale;
        move.terms = synched(pitch);
        return rig.send_path(move);
    }
    bool finish(double max_s = 60) {
        const CommandId end = rig.send_path(Flush{});
        const bool isDone =
            rig.run_until([&] { return rig.answer_to(end) != nullptr; }, max_s) && rig.isDone(end);
        rig.step(3);  // a sample is complete one cycle later
        return isDone;
    }

  private:
    void begin(bool isJerkLimited) {
        if (isJerkLimited) {
            rig.set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
            rig.set(Parameter::TRAJ_MAX_JERK, 0, JERK);
            for (int j = 0; j < num_joints_; ++j) {
                rig.set(Parameter::JOINT_MAX_JERK, j, JERK);
            }
        }
        jerk_ = isJerkLimited ? JERK : 1e300;
        rig.ready();
        rig.before_step = [this](testing::MotionRig &r) { turn(r); };
        rig.step(20);
    }
    /// By the motors' commands.
    Sample here(testing::MotionRig &r) const {
        Sample s;
        for (std::size_t j = 0; j < static_cast<std::size_t>(num_joints_); ++j) {
            s.joints[j] = r.out->joint[j].motor_pos_cmd;
        }
        geometry::Pose pose =
            r.status().carte_pos_cmd;  // if only an inverse is known, iteration starts there
        if (model != nullptr) {
            model->forward(s.joints.data(), pose);
        }
        s.x = model != nullptr ? pose[geometry::AXIS_X] - base[geometry::AXIS_X] : s.joints[0];
        s.z = model != nullptr ? pose[geometry::AXIS_Z] - base[geometry::AXIS_Z] : s.joints[2];
        s.pose = pose;
        s.turns = plant.turns();
        s.speed = plant.speed();
        s.command_rpm = r.out->spindle[0].speed_rpm;
        return s;
    }
    void turn(testing::MotionRig &r) {
        command_ = isDriveDead ? command_ : r.out->spindle[0].speed_rpm / 60.0;
        plant.run(command_, samples.empty() ? 0.0 : load(samples.back()), T);
        if (r.cycle > 1) {
            samples.push_back(here(r));
        }
        // The speed as an encoder counter reports it: counts over the last eight periods.
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

    int num_joints_ = 3;
    double jerk_ = 1e300;
    double command_ = 0;
    std::vector<double> shown_;
};

inline constexpr double PITCH = 1.25, TOP = 5, BOTTOM = -20;

inline plants::SpindleTraits tap_spindle(double seconds_to_1000_rpm = 0.5) {
    plants::SpindleTraits traits;
    traits.ramp = 1000.0 / 60 / seconds_to_1000_rpm;
    traits.first_turns = 0.61;
    return traits;
}

/// True properties of a hole.
struct Hole {
    bool isMade = false;
    bool isOut = false;   ///< the spindle has reversed twice
    double bottom = TOP;  ///< lowest Z
    double top = -1e9;    ///< maximum Z during the retract
    double farthest = 0;  ///< maximum distance of Z from the helix during both reversals, over the pitch
    double back_rpm = 0;  ///< maximum speed during the retract
};

/// The hole according to the samples after `from`, beginning when the tool is 4 deep. `sense`: spindle
/// direction during the feed in.
inline Hole hole_of(const std::vector<SpindleBench::Sample> &s, std::size_t from, double pitch,
                    double sense = 1) {
    Hole hole;
    std::vector<double> phases;
    std::size_t i = from;
    while (i < s.size() && s[i].z > TOP - 4) {
        ++i;
    }
    bool isBack = false;
    for (; i < s.size() && !hole.isOut; ++i) {
        hole.bottom = std::min(hole.bottom, s[i].z);
        isBack = isBack || sense * s[i].speed < 0;
        hole.isOut = isBack && sense * s[i].speed > 0;
        hole.top = isBack ? std::max(hole.top, s[i].z) : hole.top;
        hole.back_rpm = isBack ? std::max(hole.back_rpm, -60 * sense * s[i].speed) : hole.back_rpm;
        if (!hole.isOut) {
            phases.push_back(s[i].z / pitch + sense * s[i].turns);
        }
    }
    std::vector<double> sorted(phases.begin(), phases.begin() + std::min<long>(200, long(phases.size())));
    std::sort(sorted.begin(), sorted.end());
    for (const double p : phases) {
        hole.farthest = std::max(hole.farthest, std::abs(p - sorted[sorted.size() / 2]));
    }
    return hole;
}

/// For samples of a cut along Z with a lead: the phase of its helix at Z 0, and the maximum deviation.
struct Helix {
    double phase = 0;     ///< turn of the rotor at Z 0, the median [turns]
    double farthest = 0;  ///< from it [turns]
};
/// Z falls by `lead` per revolution. `from`, `to`: samples.
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
