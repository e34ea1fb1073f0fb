// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/halui/halui.hh"

#include <algorithm>
#include <cmath>

namespace mw::halui {
namespace {

bool isStop(const messages::Command &command) {
    const auto *state = std::get_if<messages::SetState>(&command);
    const bool off = state != nullptr && state->state != messages::State::ON;
    return off || std::holds_alternative<messages::AbortAll>(command);
}

bool isRenewal(const messages::Command &command) {
    const auto *jog = std::get_if<messages::JogContinuous>(&command);
    return jog != nullptr && jog->isRenewal;
}

}  // namespace

Result<> Halui::create(hal::Instance &hal, const HaluiSettings &settings) {
    const auto id = hal.components().create("halui");
    if (!id.has_value()) {
        return std::unexpected(id.error());
    }
    hal_ = &hal;
    comp_id_ = *id;
    settings_ = settings;
    mdi_ = MdiPins(settings.mdi_commands);
    Result<> status;
    make_pins(status);
    if (status.has_value()) {
        status = hal.components().set_ready(comp_id_);
    }
    if (!status.has_value()) {
        destroy();
    }
    return status;
}

void Halui::make_pins(Result<> &status) {
    const auto make = [this, &status](auto &set, int number) { set.make(*hal_, comp_id_, number, status); };
    make_buttons(pins::BUTTONS, 0, 0, status);
    make_buttons(pins::SELECTED_BUTTONS, 0, SELECTED, status);
    make(lamps_, 0);
    make(joint_jog_settings_, 0);
    make(axis_jog_settings_, 0);
    make(selected_joint_.pins, 0);
    make(selected_axis_.pins, 0);
    make(selected_lamps_, 0);
    make(feed_.pins, 0);
    make(rapid_.pins, 0);
    make(velocity_.pins, 0);
    joints_.resize(static_cast<std::size_t>(settings_.num_joints));
    joint_lamps_.resize(joints_.size());
    for (int joint = 0; joint < settings_.num_joints; ++joint) {
        make_buttons(pins::JOINT_BUTTONS, joint, joint, status);
        make(joints_[static_cast<std::size_t>(joint)].pins, joint);
        make(joint_lamps_[static_cast<std::size_t>(joint)], joint);
    }
    axes_.resize(MAX_AXES);
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        make(axes_[static_cast<std::size_t>(axis)].pins, axis);
        if (hasAxis(axis)) {
            make(axis_lamps_[static_cast<std::size_t>(axis)], axis);
        }
    }
    spindles_.resize(static_cast<std::size_t>(settings_.num_spindles));
    for (int i = 0; i < settings_.num_spindles; ++i) {
        SpindlePins &spindle = spindles_[static_cast<std::size_t>(i)];
        make_buttons(pins::SPINDLE_BUTTONS, i, i, status);
        make(spindle.speed, i);
        make(spindle.override_dial.pins, i);
        make(spindle.lamps, i);
    }
    mdi_buttons_.resize(mdi_.count());
    for (std::size_t i = 0; i < mdi_buttons_.size(); ++i) {
        make(mdi_buttons_[i], static_cast<int>(i));
    }
}

template <class Table>
void Halui::make_buttons(const Table &table, int instance, int number, Result<> &status) {
    sdk::for_each_pin(table, [&](const char *scope, const auto &row) {
        using Make = std::remove_cvref_t<decltype(row.read)>;
        HaluiButton button;
        button.make = [](int of) { return messages::Command(Make{}(of)); };
        button.number = number;
        button.pin.make(*hal_, comp_id_, hal::pin_name(scope, row.name, instance), hal::Dir::IN, status);
        buttons_.push_back(std::move(button));
    });
}

void Halui::destroy() {
    if (hal_ != nullptr) {
        static_cast<void>(hal_->components().remove(comp_id_));
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

client::Serial Halui::ask(const messages::Command &command) {
    const auto posted = client_->post(command);
    if (!posted.has_value()) {
        rejected_ = true;
        ++refusals_;
        return 0;
    }
    if (!isRenewal(command)) {
        pending_.push_back(*posted);
    }
    return *posted;
}

void Halui::note_outcomes() {
    std::erase_if(pending_, [this](client::Serial serial) {
        const messages::Progress progress = client_->outcome(serial).progress;
        const bool ended = progress != messages::Progress::STARTED;
        if (ended) {
            rejected_ = progress != messages::Progress::DONE;
            refusals_ += rejected_ ? 1 : 0;
        }
        return ended;
    });
}

void Halui::step() {
    note_outcomes();
    const std::int64_t now_ns = client_->status().time_ns;
    step_buttons();
    step_selection(joints_, joint_);
    step_selection(axes_, axis_);
    step_jogs(now_ns);
    step_dials();
    for (int i = 0; i < settings_.num_spindles; ++i) {
        step_spindle(i);
    }
    step_mdi();
    if (client_->read_status().has_value()) {
        show();
    }
}

void Halui::step_buttons() {
    for (HaluiButton &button : buttons_) {
        const bool on = button.pin;
        const bool pressed = on && !button.wasOn;
        if (!pressed) {
            button.wasOn = on;
            continue;
        }
        const messages::Command command = button.make(button.number == SELECTED ? joint_ : button.number);
        if (isStop(command)) {
            mdi_.drop();
        }
        // If task has no space for a command, it is posted again in the next cycle.
        const auto posted = client_->post(command);
        button.wasOn = posted.has_value();
        if (posted.has_value()) {
            pending_.push_back(*posted);
        }
    }
}

template <class Set>
void Halui::step_selection(std::vector<Set> &sets, int &selected) {
    for (std::size_t i = 0; i < sets.size(); ++i) {
        JogInputs in;
        sets[i].pins.read(in);
        const bool present = sets.size() != MAX_AXES || hasAxis(static_cast<int>(i));
        if (sets[i].select.step(in.is_select) && present) {
            selected = static_cast<int>(i);
        }
    }
}

void Halui::step_jogs(std::int64_t now_ns) {
    const auto jog = [this, now_ns](auto &one, const JogSettings &settings, const JogPins::Target &target) {
        JogInputs in;
        one.pins.read(in);
        if (one.order != 0 && client_->outcome(one.order).progress == messages::Progress::REFUSED) {
            one.jog.note_refusal();
            one.order = 0;
        }
        for (const messages::Command &command : one.jog.step(in, settings, target, now_ns)) {
            const client::Serial serial = ask(command);
            one.order = std::holds_alternative<messages::JogContinuous>(command) ? serial : one.order;
        }
    };
    JogSettings settings;
    joint_jog_settings_.read(settings);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
        jog(joints_[i], settings, {true, static_cast<int>(i)});
    }
    jog(selected_joint_, settings, {true, joint_});
    axis_jog_settings_.read(settings);
    for (std::size_t i = 0; i < axes_.size(); ++i) {
        jog(axes_[i], settings, {false, static_cast<int>(i)});
    }
    jog(selected_axis_, settings, {false, axis_});
}

template <class Dialled, class Make>
void Halui::step_dial(Dialled &one, double value, const DialRange &range, Make make) {
    if (one.order != 0 && client_->outcome(one.order).progress != messages::Progress::STARTED) {
        one.order = 0;
        one.dial.settle();
    }
    DialInputs in;
    one.pins.read(in);
    const auto wanted = one.dial.step(in, value, range);
    if (wanted.has_value()) {
        one.order = ask(make(*wanted));
    }
}

void Halui::step_dials() {
    const messages::OverridesStatus &now = client_->status().overrides;
    step_dial(feed_, now.feed, {0, settings_.max_feed_override},
              [](double value) { return messages::SetFeedOverride{value}; });
    step_dial(rapid_, now.rapid, {0, 1}, [](double value) { return messages::SetRapidOverride{value}; });
    step_dial(velocity_, client_->status().settings.max_velocity, {0, settings_.max_velocity},
              [](double value) { return messages::SetMaxVelocity{value}; });
}

void Halui::step_spindle(int number) {
    SpindlePins &one = spindles_[static_cast<std::size_t>(number)];
    const messages::SpindleStatus &now = client_->status().spindles[static_cast<std::size_t>(number)];
    step_dial(one.override_dial, now.override_factor, settings_.spindle_override,
              [number](double value) { return messages::SetSpindleOverride{value, number}; });
    SpindleInputs in;
    one.speed.read(in);
    constexpr double SLOWEST_RPM = 1, STEP_RPM = 100;
    constexpr std::size_t S = 2;  // index in the settings of the modal codes
    const double programmed_rpm = std::max(SLOWEST_RPM, std::abs(client_->status().codes.settings[S]));
    const double turning_rpm = now.isOn ? std::abs(now.speed_cmd_rpm) : 0;
    const auto turn = [this, number](double rpm, bool reverse) {
        ask(messages::SpindleOn{number, reverse ? -rpm : rpm});
    };
    const bool is_start = one.edges[0].step(in.is_start), forward = one.edges[1].step(in.isForward);
    if (is_start || forward) {
        turn(programmed_rpm, false);
    }
    if (one.edges[2].step(in.isReverse)) {
        turn(programmed_rpm, true);
    }
    const bool faster = one.edges[3].step(in.is_increase), slower = one.edges[4].step(in.is_decrease);
    if ((faster || slower) && turning_rpm == 0) {
        rejected_ = true;  // the spindle is stopped, and a change of its speed does not start it
        ++refusals_;
    } else if (faster != slower) {
        const double rpm = turning_rpm + (faster ? STEP_RPM : -STEP_RPM);
        turn(std::max(SLOWEST_RPM, rpm), now.direction < 0);
    }
}

void Halui::step_mdi() {
    std::vector<bool> on;
    for (const auto &button : mdi_buttons_) {
        MdiInput in;
        button.read(in);
        on.push_back(in.isOn);
    }
    mdi_.step(on, *client_, [this](const messages::Command &command) { return ask(command); });
}

void Halui::show() {
    const messages::MachineStatus &status = client_->status();
    const auto tools = client_->read_tools();
    if (tools.has_value() && tools->has_value()) {
        tool_diameter_ = (*tools)->tools.empty() ? 0 : (*tools)->tools[0].diameter;
    }
    lamps_.write(Shown{status, joint_, axis_, tool_diameter_, settings_.units_per_mm, rejected_, refusals_});
    for (std::size_t i = 0; i < joint_lamps_.size(); ++i) {
        joint_lamps_[i].write(
            JointShown{{status.joints[i], status.settings.joints[i]}, static_cast<int>(i) == joint_});
    }
    const auto selected = static_cast<std::size_t>(joint_);
    selected_lamps_.write(JointShown{{status.joints[selected], status.settings.joints[selected]}, true});
    show_axes(status);
    for (std::size_t i = 0; i < spindles_.size(); ++i) {
        spindles_[i].lamps.write(status.spindles[i]);
        spindles_[i].override_dial.pins.write(status.spindles[i].override_factor);
    }
    feed_.pins.write(status.overrides.feed);
    rapid_.pins.write(status.overrides.rapid);
    velocity_.pins.write(status.settings.max_velocity);
}

void Halui::show_axes(const messages::MachineStatus &status) {
    const geometry::Pose relative = legacy::program_position(status, status.trajectory.position_cmd);
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if (hasAxis(axis)) {
            axis_lamps_[static_cast<std::size_t>(axis)].write(AxisShown{status.trajectory.position_cmd[axis],
                                                                        status.trajectory.position_fb[axis],
                                                                        relative[axis], axis == axis_});
        }
    }
}

}  // namespace mw::halui
