// SPDX-License-Identifier: GPL-2.0-or-later
// Machines whose joints are linear functions of the axes, with external offsets, for tests. Motor commands
// are checked as joints and as axes by independent formulas.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kinematics/corexy.hh"
#include "kinematics/matrix.hh"
#include "kinematics/rotate.hh"
#include "tests/support/limit_checker.hh"
#include "tests/support/motion_rig.hh"

namespace mw::testing {

struct CoordinateLimits {
    double velocity = 100, acceleration = 1000;
    double jerk = 0;  ///< 0: none
    double low = -100, high = 100;

    AxisLimit judged() const { return {velocity, acceleration, jerk > 0 ? jerk : 1e300}; }
};

struct LinearMachine {
    std::string name;
    std::shared_ptr<kinematics::Kinematics> model;
    int num_joints = 3;  ///< and axes, X first
    std::array<CoordinateLimits, 9> axes{}, joints{};
    std::array<double, 9> ratio{};  ///< [AXIS_L]OFFSET_AV_RATIO
    bool isJerkLimited = false;
    std::function<geometry::Pose(const double *joints)> pose_of;

    std::shared_ptr<kinematics::Matrix> matrix;  ///< the model, if it measures axes
};

inline LinearMachine corexy() {
    LinearMachine m;
    m.name = "CoreXY";
    m.model = std::make_shared<kinematics::CoreXy>();
    m.pose_of = [](const double *q) {
        return geometry::Pose{{0.5 * (q[0] + q[1]), 0.5 * (q[0] - q[1]), q[2]}};
    };
    return m;
}

/// Solves by Gaussian elimination with pivots, independently of the model.
inline geometry::Pose solved(std::array<std::array<double, 4>, 3> rows) {
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = i + 1; k < 3; ++k) {
            if (std::abs(rows[k][i]) > std::abs(rows[i][i])) {
                std::swap(rows[k], rows[i]);
            }
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const double factor = k == i ? 0.0 : rows[k][i] / rows[i][i];
            for (std::size_t n = i; n < 4; ++n) {
                rows[k][n] -= factor * rows[i][n];
            }
        }
    }
    return {{rows[0][3] / rows[0][0], rows[1][3] / rows[1][1], rows[2][3] / rows[2][2]}};
}

/// matrixkins, rows of joints.
inline LinearMachine measured(const std::array<double, 9> &c) {
    LinearMachine m;
    m.name = "measured";
    auto model = std::make_shared<kinematics::Matrix>();
    for (std::size_t i = 0; i < c.size(); ++i) {
        model->set(i, c[i]);
    }
    m.model = m.matrix = model;
    m.pose_of = [c](const double *q) {
        return solved({{{c[0], c[1], c[2], q[0]}, {c[3], c[4], c[5], q[1]}, {c[6], c[7], c[8], q[2]}}});
    };
    return m;
}

/// rotatekins: X and Y rotate with C.
inline LinearMachine turned_table() {
    LinearMachine m;
    m.name = "turned table";
    m.model = std::make_shared<kinematics::Rotate>();
    m.num_joints = 6;
    m.pose_of = [](const double *q) {
        const double c = q[5] * 3.14159265358979323846 / 180;
        return geometry::Pose{{q[0] * std::cos(c) + q[1] * std::sin(c),
                               q[1] * std::cos(c) - q[0] * std::sin(c), q[2], q[3], q[4], q[5]}};
    };
    return m;
}

/// Checks every sample.
class LinearRig {
  public:
    static constexpr double T = MotionRig::T;

    explicit LinearRig(const LinearMachine &made)
        : machine(made), rig(std::make_unique<MotionRig>(*machine.model, machine.num_joints, 100, 1000)) {
        using motion::Parameter;
        std::vector<AxisLimit> of_joints;
        std::vector<AxisLimit> of_axes;
        for (int i = 0; i < machine.num_joints; ++i) {
            const CoordinateLimits &axis = machine.axes[static_cast<std::size_t>(i)];
            const CoordinateLimits &joint = machine.joints[static_cast<std::size_t>(i)];
            const auto jerk = [](const CoordinateLimits &c) {
                return c.jerk > 0 ? c.jerk : motion::NO_JERK_LIMIT;
            };
            rig->set(Parameter::JOINT_IS_ANGULAR, i, geometry::isAngular(i) ? 1 : 0);
            rig->set(Parameter::JOINT_MAX_VELOCITY, i, joint.velocity);
            rig->set(Parameter::JOINT_MAX_ACCELERATION, i, joint.acceleration);
            rig->set(Parameter::JOINT_MAX_JERK, i, jerk(joint));
            rig->set(Parameter::JOINT_MIN_LIMIT, i, joint.low);
            rig->set(Parameter::JOINT_MAX_LIMIT, i, joint.high);
            rig->set(Parameter::AXIS_MAX_VELOCITY, i, axis.velocity);
            rig->set(Parameter::AXIS_MAX_ACCELERATION, i, axis.acceleration);
            rig->set(Parameter::AXIS_MAX_JERK, i, jerk(axis));
            rig->set(Parameter::AXIS_MIN_LIMIT, i, axis.low);
            rig->set(Parameter::AXIS_MAX_LIMIT, i, axis.high);
            rig->set(Parameter::AXIS_OFFSET_RATIO, i, machine.ratio[static_cast<std::size_t>(i)]);
            pins(i).isEnabled = true;
            pins(i).scale = 0.01;
            of_joints.push_back(joint.judged());
            of_axes.push_back(axis.judged());
        }
        if (machine.isJerkLimited) {
            rig->set(Parameter::TRAJ_MAX_JERK, 0, 1e7);
            rig->set(Parameter::TRAJ_PLANNER_TYPE, 0, 1);
        }
        rig->step(6);
        joints = std::make_unique<LimitChecker>(of_joints, T);
        axes = std::make_unique<LimitChecker>(of_axes, T);
    }
    motion::OffsetInput &pins(int axis) { return rig->in.axis_offset[static_cast<std::size_t>(axis)]; }
    double offset(int axis) const { return rig->out->axis[static_cast<std::size_t>(axis)].offset; }
    double request(int axis) const { return rig->out->axis[static_cast<std::size_t>(axis)].offset_request; }
    double motor(int joint) const { return rig->out->joint[static_cast<std::size_t>(joint)].motor_pos_cmd; }
    double shown(int axis) const { return rig->out->axis[static_cast<std::size_t>(axis)].position; }
    geometry::Pose pose() const {
        double q[9] = {};
        for (int j = 0; j < machine.num_joints; ++j) {
            q[j] = motor(j);
        }
        return machine.pose_of(q);
    }
    /// Result of the program.
    geometry::Pose programmed() const {
        geometry::Pose p = pose();
        for (int i = 0; i < machine.num_joints; ++i) {
            p[i] -= offset(i);
        }
        return p;
    }
    void begin(motion::Mode mode) { rig->ready(mode); }
    void go(int cycles) {
        for (int n = 0; n < cycles; ++n) {
            rig->step();
            judge();
        }
    }
    motion::CommandId line(const geometry::Pose &end, double feed) { return rig->line(end, feed); }
    /// True when all queued moves are done.
    bool finish(int most_s = 20) {
        const motion::CommandId id = rig->send_path(motion::Flush{});
        for (int n = 0; n < 1000 * most_s && !rig->isDone(id); ++n) {
            go(1);
        }
        return rig->isDone(id);
    }
    std::string report() const {
        std::string text;
        text += joints->isWithin() ? "" : "joints: " + joints->report();
        text += axes->isWithin() ? "" : "axes: " + axes->report();
        return text + places;
    }
    void expect_within() const { EXPECT_EQ(report(), ""); }

    LinearMachine machine;
    std::unique_ptr<MotionRig> rig;
    std::unique_ptr<LimitChecker> joints, axes;
    std::string places;
    double worst_outside = -1e300;  ///< distance outside soft limits
    bool isJudged = true;

  private:
    void judge() {
        if (!isJudged) {
            return;
        }
        double q[9] = {};
        const geometry::Pose p = pose();
        for (int j = 0; j < machine.num_joints; ++j) {
            const auto n = static_cast<std::size_t>(j);
            q[j] = motor(j);
            note(j, "joint", q[j], machine.joints[n]);
            note(j, "axis", p[j], machine.axes[n]);
        }
        joints->sample(q);
        axes->sample(p.c.data());
    }
    void note(int i, const char *what, double x, const CoordinateLimits &limits) {
        constexpr double ROUNDING = 3e-6;
        const double outside = std::max(limits.low - x, x - limits.high);
        worst_outside = std::max(worst_outside, outside);
        if (outside > ROUNDING && places.size() < 500) {
            places += std::string(what) + ' ' + std::to_string(i) + " at " + std::to_string(x) + '\n';
        }
    }
};

}  // namespace mw::testing
