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
    Result<> status;
    make_buttons(pins::BUTTONS, 0, status);
    for (int joint = 0; joint < num_joints_; ++joint) {
        make_buttons(pins::JOINT_BUTTONS, joint, status);
    }
    lamps_.make(hal, comp_id_, 0, status);
    for (int joint = 0; joint < num_joints_; ++joint) {
        joint_lamps_[static_cast<std::size_t>(joint)].make(hal, comp_id_, joint, status);
    }
    if (status.has_value()) {
        status = hal.set_ready(comp_id_);
    }
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

template <class Table>
void Halui::make_buttons(const Table &table, int number, Result<> &status) {
    sdk::for_each_pin(table, [&](const char *scope, const auto &row) {
        Button button{{}, row.read(number)};
        button.pin.make(*hal_, comp_id_, hal::pin_name(scope, row.name, number), hal::Dir::IN, status);
        buttons_.push_back(std::move(button));
    });
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
    if (!client_->read_status().has_value()) {
        return;
    }
    const msgs::MachineStatus &status = client_->status();
    lamps_.write(status);
    for (int joint = 0; joint < num_joints_; ++joint) {
        const auto i = static_cast<std::size_t>(joint);
        joint_lamps_[i].write(status.joints[i]);
    }
}

}  // namespace mw::ui
