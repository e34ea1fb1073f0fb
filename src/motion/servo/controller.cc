// SPDX-License-Identifier: GPL-2.0-or-later
// The stages of a servo cycle. [[likely]] and [[unlikely]] here, in the stages and in the parts mark the path
// of a cycle without events. Between two cycles the processor loses its branch predictions, and each taken
// branch costs as much as a dozen instructions (docs/developer/performance.md). Functions on that path are
// hot, those for events cold. The linker groups them, so that a cycle uses fewer pages and cache lines of the
// module.
#include "motion/servo/controller.hh"

#include "motion/servo/compensation.hh"
#include "motion/servo/feedback.hh"
#include "motion/servo/homing_stage.hh"
#include "motion/servo/indexer_stage.hh"
#include "motion/servo/jog_stage.hh"
#include "motion/servo/kinematics_switch.hh"
#include "motion/servo/motion_mode.hh"
#include "motion/servo/path_stage.hh"
#include "motion/servo/status_writer.hh"

namespace mw::motion {

Controller::Controller(const ControllerConfig &config, const kinematics::Kinematics &kinematics,
                       Channels &channels, PathLink &link) noexcept
    : parts_(config, kinematics, channels, link) {}

Controller::Controller(const Controller &other, Channels &channels, PathLink &link) noexcept
    : parts_(other.parts_, channels, link), safety_(other.safety_), dispatcher_(other.dispatcher_) {}

void Controller::handle_commands(const Inputs &in) noexcept {
    dispatcher_.handle_commands(parts_, safety_, in);
}

void Controller::step(const Inputs &in, Outputs &out) noexcept {
    ++parts_.cycle;
    finish_stop(parts_);
    const std::uint32_t spindles_lost = read_feedback(parts_, in);
    safety_.step(parts_, in, spindles_lost);
    apply_holds(parts_, in);
    step_kinematics_type(parts_, in);
    follow_spindles(parts_);
    if (parts_.power.isEnabled()) [[likely]] {
        command_joints(in);
    } else {
        parts_.executor.step(parts_.cycle);
    }
    command_motors(parts_);
    command_spindles(parts_, in);
    parts_.homing.write_pins();
    write_status(parts_, {in, dispatcher_.epoch(), dispatcher_.last_id(), safety_.isTaskLost()}, out);
    parts_.probe.end_cycle(in.isProbeClosed);
}

void Controller::command_joints(const Inputs &in) noexcept {
    step_homing(parts_, in);
    step_jogs(parts_, in);
    if (!parts_.indexers.isEmpty()) [[unlikely]] {
        step_indexers(parts_, in);
    }
    motion_mode(parts_.power.mode()).step(parts_, in);
    if (parts_.extra.count() > 0) [[unlikely]] {
        command_extra_joints(parts_, in);
    }
}

}  // namespace mw::motion
