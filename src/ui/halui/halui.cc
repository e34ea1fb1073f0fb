// SPDX-License-Identifier: GPL-2.0-or-later
#include "ui/halui/halui.hh"

namespace mw::ui {

Result<> Halui::create(hal::Hal &hal, int num_joints) {
    const auto id = hal.new_component("halui");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    num_joints_ = num_joints;
    auto status = make_buttons();
    if (status.has_value()) {
        status = make_states();
    }
    if (status.has_value()) {
        status = hal.set_ready(comp_id_);
    }
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

void Halui::add_button(const std::string &name, task::Command command, Result<> &status) {
    Button button{{}, std::move(command)};
    button.pin.make(*hal_, comp_id_, "halui." + name, hal::Dir::IN, status);
    buttons_.push_back(std::move(button));
}

Result<> Halui::make_buttons() {
    Result<> status;
    add_button("machine.on", task::SetState{task::State::ON}, status);
    add_button("machine.off", task::SetState{task::State::OFF}, status);
    add_button("estop.activate", task::SetState{task::State::ESTOP}, status);
    add_button("estop.reset", task::SetState{task::State::ESTOP_RESET}, status);
    add_button("mode.auto", task::SetMode{task::Mode::AUTO}, status);
    add_button("mode.manual", task::SetMode{task::Mode::MANUAL}, status);
    add_button("mode.mdi", task::SetMode{task::Mode::MDI}, status);
    add_button("mode.joint", task::SetTeleop{false}, status);
    add_button("mode.teleop", task::SetTeleop{true}, status);
    add_button("home-all", task::HomeJoint{-1}, status);
    add_button("abort", task::AbortAll{}, status);
    add_button("program.run", task::RunProgram{}, status);
    add_button("program.step", task::StepProgram{}, status);
    add_button("program.pause", task::PauseProgram{}, status);
    add_button("program.resume", task::ResumeProgram{}, status);
    add_button("program.stop", task::AbortAll{}, status);
    add_button("program.optional-stop.on", task::SetOptionalStop{true}, status);
    add_button("program.optional-stop.off", task::SetOptionalStop{false}, status);
    add_button("program.block-delete.on", task::SetBlockDelete{true}, status);
    add_button("program.block-delete.off", task::SetBlockDelete{false}, status);
    add_button("flood.on", task::Coolant{false, true}, status);
    add_button("flood.off", task::Coolant{false, false}, status);
    add_button("mist.on", task::Coolant{true, true}, status);
    add_button("mist.off", task::Coolant{true, false}, status);
    for (int joint = 0; joint < num_joints_; ++joint) {
        const std::string prefix = "joint." + std::to_string(joint);
        add_button(prefix + ".home", task::HomeJoint{joint}, status);
        add_button(prefix + ".unhome", task::UnhomeJoint{joint}, status);
    }
    return status;
}

Result<> Halui::make_states() {
    Result<> status;
    const auto out = [&](hal::UserPin<bool> &pin, const std::string &name) {
        pin.make(*hal_, comp_id_, "halui." + name, hal::Dir::OUT, status);
    };
    out(machine_is_on_, "machine.is-on");
    out(estop_is_activated_, "estop.is-activated");
    out(is_auto_, "mode.is-auto");
    out(is_manual_, "mode.is-manual");
    out(is_mdi_, "mode.is-mdi");
    out(is_joint_, "mode.is-joint");
    out(is_teleop_, "mode.is-teleop");
    out(program_is_idle_, "program.is-idle");
    out(program_is_running_, "program.is-running");
    out(program_is_paused_, "program.is-paused");
    for (int joint = 0; joint < num_joints_; ++joint) {
        out(joint_is_homed_[static_cast<std::size_t>(joint)], "joint." + std::to_string(joint) + ".is-homed");
    }
    return status;
}

void Halui::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->delete_component(comp_id_));
        hal_ = nullptr;
        buttons_.clear();
    }
}

void Halui::step(task::Task &task) {
    for (Button &button : buttons_) {
        const bool isOn = button.pin;
        if (isOn && !button.wasOn) {
            task.submit(button.command);
        }
        button.wasOn = isOn;
    }
    const task::Status &status = task.status();
    const motion::Status &motion = task.motion_status();
    machine_is_on_ = status.state == task::State::ON;
    estop_is_activated_ = status.state == task::State::ESTOP;
    is_auto_ = status.mode == task::Mode::AUTO;
    is_manual_ = status.mode == task::Mode::MANUAL;
    is_mdi_ = status.mode == task::Mode::MDI;
    is_joint_ = motion.mode == motion::Mode::FREE;
    is_teleop_ = motion.mode == motion::Mode::TELEOP;
    program_is_idle_ = status.interp_state == task::InterpState::IDLE;
    program_is_paused_ = status.interp_state == task::InterpState::PAUSED;
    program_is_running_ = status.interp_state != task::InterpState::IDLE && !program_is_paused_;
    for (int joint = 0; joint < num_joints_; ++joint) {
        const auto i = static_cast<std::size_t>(joint);
        joint_is_homed_[i] = motion.joint[i].isHomed;
    }
}

}  // namespace mw::ui
