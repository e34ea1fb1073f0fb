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

void Halui::add_button(const std::string &name, msgs::Command command, Result<> &status) {
    Button button{{}, std::move(command)};
    button.pin.make(*hal_, comp_id_, "halui." + name, hal::Dir::IN, status);
    buttons_.push_back(std::move(button));
}

Result<> Halui::make_buttons() {
    Result<> status;
    add_button("machine.on", msgs::SetState{msgs::State::ON}, status);
    add_button("machine.off", msgs::SetState{msgs::State::OFF}, status);
    add_button("estop.activate", msgs::SetState{msgs::State::ESTOP}, status);
    add_button("estop.reset", msgs::SetState{msgs::State::ESTOP_RESET}, status);
    add_button("mode.auto", msgs::SetMode{msgs::Mode::AUTO}, status);
    add_button("mode.manual", msgs::SetMode{msgs::Mode::MANUAL}, status);
    add_button("mode.mdi", msgs::SetMode{msgs::Mode::MDI}, status);
    add_button("mode.joint", msgs::SetTeleop{false}, status);
    add_button("mode.teleop", msgs::SetTeleop{true}, status);
    add_button("home-all", msgs::HomeJoint{-1}, status);
    add_button("abort", msgs::AbortAll{}, status);
    add_button("program.run", msgs::RunProgram{}, status);
    add_button("program.step", msgs::StepProgram{}, status);
    add_button("program.pause", msgs::PauseProgram{}, status);
    add_button("program.resume", msgs::ResumeProgram{}, status);
    add_button("program.stop", msgs::AbortAll{}, status);
    add_button("program.optional-stop.on", msgs::SetOptionalStop{true}, status);
    add_button("program.optional-stop.off", msgs::SetOptionalStop{false}, status);
    add_button("program.block-delete.on", msgs::SetBlockDelete{true}, status);
    add_button("program.block-delete.off", msgs::SetBlockDelete{false}, status);
    add_button("flood.on", msgs::FloodOn{}, status);
    add_button("flood.off", msgs::FloodOff{}, status);
    add_button("mist.on", msgs::MistOn{}, status);
    add_button("mist.off", msgs::MistOff{}, status);
    for (int joint = 0; joint < num_joints_; ++joint) {
        const std::string prefix = "joint." + std::to_string(joint);
        add_button(prefix + ".home", msgs::HomeJoint{joint}, status);
        add_button(prefix + ".unhome", msgs::UnhomeJoint{joint}, status);
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
        client_.reset();
    }
}

Result<> Halui::join(mailbox::Segment &mailbox) {
    auto client = client::Client::join(mailbox, client::Role::PANEL);
    if (!client.has_value()) {
        return std::unexpected(client.error());
    }
    client_.emplace(std::move(*client));
    return {};
}

void Halui::step() {
    for (Button &button : buttons_) {
        const bool isOn = button.pin;
        const bool isPressed = isOn && !button.wasOn;
        // One that task has no room for is tried again in the next cycle.
        button.wasOn = isPressed ? client_->post(button.command).has_value() : isOn;
    }
    if (!client_->read_status(status_).has_value()) {
        return;
    }
    const msgs::MachineStatus &status = status_;
    machine_is_on_ = status.task.state == msgs::State::ON;
    estop_is_activated_ = status.task.state == msgs::State::ESTOP;
    is_auto_ = status.task.mode == msgs::Mode::AUTO;
    is_manual_ = status.task.mode == msgs::Mode::MANUAL;
    is_mdi_ = status.task.mode == msgs::Mode::MDI;
    is_joint_ = status.trajectory.mode == msgs::MotionMode::FREE;
    is_teleop_ = status.trajectory.mode == msgs::MotionMode::TELEOP;
    program_is_idle_ = status.task.interp_state == msgs::InterpState::IDLE;
    program_is_paused_ = status.task.interp_state == msgs::InterpState::PAUSED;
    program_is_running_ = status.task.interp_state != msgs::InterpState::IDLE && !program_is_paused_;
    for (int joint = 0; joint < num_joints_; ++joint) {
        const auto i = static_cast<std::size_t>(joint);
        joint_is_homed_[i] = status.joints[i].isHomed;
    }
}

}  // namespace mw::ui
