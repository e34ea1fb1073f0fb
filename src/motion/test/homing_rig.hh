// SPDX-License-Identifier: GPL-2.0-or-later
// A motion controller whose joints are simulated axes with home switches and index pulses.
#pragma once

#include <string>
#include <vector>

#include "components/plants/home_axis.hh"
#include "motion/interface/texts.hh"
#include "tests/support/motion_rig.hh"

namespace mw::testing {

/// Simulated axes between the motor commands and the feedback of the rig.
struct HomingRig {
    MotionRig rig;
    std::vector<plants::HomeAxis> axes;

    explicit HomingRig(const char *coordinates = "XYZ") : rig(coordinates, 50, 500) {}
    void set_up(const std::vector<plants::HomeAxis::Build> &builds) {
        for (const plants::HomeAxis::Build &build : builds) {
            axes.emplace_back(build);
        }
        rig.before_step = [this](MotionRig &r) {
            for (std::size_t j = 0; j < axes.size(); ++j) {
                motion::JointInputs &in = r.in.joint[j];
                axes[j].step(r.out->joint[j].motor_pos_cmd, r.out->joint[j].isIndexEnabled, MotionRig::T);
                in.motor_pos_fb = axes[j].encoder();
                in.isHomeSwitchClosed = axes[j].isSwitchClosed();
                in.isIndexEnabled = axes[j].isIndexEnabled();
            }
        };
    }
    void set(motion::Parameter p, double value, int joint = 0) { rig.set(p, joint, value); }
    void set_switch(int joint, double search, double latch) {
        set(motion::Parameter::JOINT_HOME_SEARCH_VEL, search, joint);
        set(motion::Parameter::JOINT_HOME_LATCH_VEL, latch, joint);
        rig.step(2);
    }
    void home(int joint = -1) {
        rig.send(motion::Enable{});
        rig.send(motion::Home{joint});
        rig.step(3);
    }
    bool wait(double longest_s = 120) {
        return rig.run_until([this] { return !rig.status().isHoming; }, longest_s);
    }
    bool isHomed(int joint) const { return rig.status().joint[static_cast<std::size_t>(joint)].isHomed; }
    double pos_fb(int joint) const { return rig.status().joint[static_cast<std::size_t>(joint)].pos_fb; }
    double pos_cmd(int joint) const { return rig.status().joint[static_cast<std::size_t>(joint)].pos_cmd; }
    /// Position of the slide when the joint is at 0.
    double zero(int joint) const { return axes[static_cast<std::size_t>(joint)].slide() - pos_fb(joint); }
    std::string fault() const { return rig.faults.empty() ? "" : motion::fault_text(rig.faults.front()); }
};

}  // namespace mw::testing
