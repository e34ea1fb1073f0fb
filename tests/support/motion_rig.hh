// SPDX-License-Identifier: GPL-2.0-or-later
// A motion controller with its path planner and ideal drives, stepped in virtual time, for tests.
#pragma once

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kinematics/trivial.hh"
#include "motion/planner/path_planner.hh"
#include "motion/servo/controller.hh"
#include "tests/support/limit_checker.hh"

namespace mw::testing {

/// Drives follow the command one cycle later. A test may read and change all parts between steps. On
/// machines whose joints are not axes, every sample is checked against the joint limits; a rig that exceeded
/// them ends the test program in its destructor.
struct MotionRig {
    static constexpr double T = 1e-3;
    static constexpr int PLANNER_PERIOD = 5;

    kinematics::Trivial kinematics;
    std::unique_ptr<motion::Channels> channels = std::make_unique_for_overwrite<motion::Channels>();
    std::unique_ptr<motion::PathLink> link = std::make_unique_for_overwrite<motion::PathLink>();
    std::unique_ptr<motion::Controller> controller;
    std::unique_ptr<motion::PathPlanner> planner;
    motion::Inputs in;
    std::unique_ptr<motion::Outputs> out = std::make_unique<motion::Outputs>();
    std::uint64_t cycle = 0;
    motion::CommandId next_id = 1;
    motion::Epoch epoch = 1;
    std::vector<motion::Answer> answers;
    std::vector<motion::Fault> faults;
    bool isPlannerAlive = true;
    std::function<void(MotionRig &)> before_step = [](MotionRig &) {};

    MotionRig(const MotionRig &) = delete;
    MotionRig &operator=(const MotionRig &) = delete;
    ~MotionRig() {
        if (const std::string report = joint_report(); !report.empty()) {
            std::fprintf(stderr, "joints outside their limits:\n%s", report.c_str());
            std::abort();
        }
    }

    explicit MotionRig(const char *coordinates = "XYZ", double velocity = 100, double acceleration = 1000) {
        kinematics.configure(coordinates);
        start(kinematics, kinematics.identity()->num_joints, velocity, acceleration);
    }
    /// The last `extra` joints are extra joints, which are not part of the kinematics.
    MotionRig(const char *coordinates, int extra) : num_extra_(extra) {
        kinematics.configure(coordinates);
        start(kinematics, kinematics.identity()->num_joints + extra, 100, 1000);
    }
    /// A machine whose joints are not axes; `model` outlives the rig.
    MotionRig(const kinematics::Kinematics &model, int joints, double velocity, double acceleration,
              int extra = 0)
        : num_extra_(extra) {
        start(model, joints, velocity, acceleration);
    }
    void start(const kinematics::Kinematics &model, int joints, double velocity, double acceleration) {
        isJudged_ = model.identity() == nullptr;
        limits_.assign(static_cast<std::size_t>(joints), {});
        low_.assign(static_cast<std::size_t>(joints), -1e300);
        high_.assign(static_cast<std::size_t>(joints), 1e300);
        controller = std::make_unique<motion::Controller>(
            motion::ControllerConfig{joints, 1, 4, 4, T, num_extra_}, model, *channels, *link);
        planner = std::make_unique<motion::PathPlanner>(
            motion::PathPlannerConfig{T, joints - num_extra_, 1, 4, 4}, model, *channels, *link);
        send(motion::Abort{epoch});
        for (int j = 0; j < joints; ++j) {
            set(motion::Parameter::JOINT_MAX_VELOCITY, j, velocity);
            set(motion::Parameter::JOINT_MAX_ACCELERATION, j, acceleration);
            set(motion::Parameter::JOINT_MIN_LIMIT, j, -1000);
            set(motion::Parameter::JOINT_MAX_LIMIT, j, 1000);
            set(motion::Parameter::JOINT_HOME_SEQUENCE, j, 0);
        }
        step(4);
    }

    motion::CommandId send(const motion::CommandBody &body) {
        channels->immediate.push({next_id, epoch, body});
        return next_id++;
    }
    motion::CommandId send_path(const motion::PathBody &body) {
        channels->path.push({next_id, epoch, body});
        return next_id++;
    }
    void set(motion::Parameter p, int index, double value) {
        note_limit(p, static_cast<std::size_t>(index), value);
        send(motion::SetParameter{static_cast<std::uint16_t>(p), static_cast<std::int16_t>(index), value});
    }
    motion::CommandId line(const geometry::Pose &end, double feed = 50,
                           motion::PathMode mode = motion::PathMode::BLEND, double tolerance = 0) {
        motion::Line move;
        move.end = end;
        move.terms.feed = feed;
        move.terms.mode = mode;
        move.terms.tolerance = tolerance;
        move.terms.isRapid = feed == 0;
        move.terms.source.line = static_cast<std::int32_t>(next_id);
        move.terms.source.block = static_cast<std::uint32_t>(next_id);
        return send_path(move);
    }

    void step(int count = 1) {
        for (int i = 0; i < count; ++i) {
            ++cycle;
            in.time_ns = static_cast<std::int64_t>(cycle) * 1000000;
            before_step(*this);
            controller->handle_commands(in);
            controller->step(in, *out);
            for (std::size_t j = 0; j < MAX_JOINTS; ++j) {
                in.joint[j].motor_pos_fb = out->joint[j].motor_pos_cmd;
            }
            if (isPlannerAlive && cycle % PLANNER_PERIOD == 0) {
                planner->update();
            }
            judge_joints();
            motion::Answer a;
            while (channels->servo_answers.pop(a) || channels->planner_answers.pop(a)) {
                answers.push_back(a);
            }
            motion::Fault f;
            while (channels->servo_faults.pop(f) || channels->planner_faults.pop(f)) {
                faults.push_back(f);
            }
        }
    }
    /// Steps until `isDone`; false after `max_s`.
    bool run_until(const std::function<bool()> &isDone, double max_s = 60) {
        for (double t = 0; t < max_s; t += T) {
            if (isDone()) {
                return true;
            }
            step();
        }
        return isDone();
    }
    const motion::Answer *answer_to(motion::CommandId id) const {
        for (const motion::Answer &a : answers) {
            if (a.id == id) {
                return &a;
            }
        }
        return nullptr;
    }
    bool isDone(motion::CommandId id) const {
        const motion::Answer *a = answer_to(id);
        return a != nullptr && a->kind == motion::AnswerKind::DONE;
    }
    /// The reason of a rejection; NONE when done, outdated or not answered.
    motion::Reason refusal(motion::CommandId id) const {
        const motion::Answer *a = answer_to(id);
        return a != nullptr && a->kind == motion::AnswerKind::REFUSED ? a->reason : motion::Reason::NONE;
    }
    /// Machine on, homed at its position, in `mode`.
    void ready(motion::Mode mode = motion::Mode::COORD) {
        send(motion::Enable{});
        step(2);
        send(motion::Home{-1});
        step(2);
        run_until([this] { return out->status.isAllHomed && !out->status.isHoming; });
        send(motion::SetMode{mode});
        step(PLANNER_PERIOD);
    }
    const motion::Status &status() const { return out->status; }

    /// Violations of joint limits; empty: none.
    std::string joint_report() const { return places_ + (checker_ ? checker_->report() : std::string()); }
    /// Clears the violations after a test has checked them.
    void forgive_joints() {
        places_.clear();
        checker_.reset();
    }

  private:
    void note_limit(motion::Parameter p, std::size_t joint, double value) {
        using motion::Parameter;
        switch (p) {
        case Parameter::JOINT_MAX_VELOCITY: limits_[joint].velocity = value; break;
        case Parameter::JOINT_MAX_ACCELERATION: limits_[joint].acceleration = value; break;
        case Parameter::JOINT_MIN_LIMIT: low_[joint] = value; break;
        case Parameter::JOINT_MAX_LIMIT: high_[joint] = value; break;
        default: return;
        }
        keep_report();
    }
    /// Settings change between moves, so the judge keeps its result and restarts with the new limits.
    void keep_report() {
        places_ = joint_report();
        checker_.reset();
    }
    void judge_joints() {
        if (!isJudged_) {
            return;
        }
        if (!out->status.isEnabled || out->status.isHoming) {
            keep_report();
            return;
        }
        if (!checker_) {
            checker_ = std::make_unique<LimitChecker>(limits_, T);
        }
        std::vector<double> positions;
        for (std::size_t j = 0; j < limits_.size(); ++j) {
            const double q = out->joint[j].motor_pos_cmd;
            constexpr double ROUNDING = 2e-6;
            const bool isOut = q < low_[j] - ROUNDING || q > high_[j] + ROUNDING;
            if (out->status.isAllHomed && isOut && places_.size() < 1000) {
                places_ += "joint " + std::to_string(j) + " at " + std::to_string(q) + "\n";
            }
            positions.push_back(q);
        }
        checker_->sample(positions.data());
    }

    int num_extra_ = 0;
    bool isJudged_ = false;
    std::vector<AxisLimit> limits_;
    std::vector<double> low_, high_;
    std::unique_ptr<LimitChecker> checker_;
    std::string places_;
};

}  // namespace mw::testing
