// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/live_bench.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mw::commissioning {

LiveBench::LiveBench(client::Client &client, hal::Hal &hal, int joints)
    : client_(client), hal_(hal), joints_(joints) {
    estop_ = find_bit(hal.hasSignal("estop-released") ? "estop-released" : "iocontrol.0.emc-enable-in");
    probe_ = find_bit("motion.probe-input");
    for (int joint = 0; joint < joints; ++joint) {
        home_switches_.push_back(find_bit(fmt::format("joint.{}.home-sw-in", joint)));
    }
}

volatile const bool *LiveBench::find_bit(const std::string &name) {
    const auto address = hal_.address_of(name, hal::Type::BIT);
    return address.has_value() ? static_cast<volatile const bool *>(*address) : nullptr;
}

void LiveBench::update() {
    static_cast<void>(client_.read_status());
    while (const auto message = client_.next_message()) {
        if (message->kind == messages::MessageKind::OPERATOR_ERROR) {
            last_error_ = message->text;
        }
    }
    post_waiting();
}

double LiveBench::now_s() const {
    constexpr double S_PER_NS = 1e-9;
    return static_cast<double>(hal_.now_ns()) * S_PER_NS;
}

bool LiveBench::isOn() const {
    return client_.status().task.state == messages::State::ON && client_.status().trajectory.isEnabled;
}

bool LiveBench::isEstopReleased() const {
    return estop_ != nullptr && *estop_;
}

bool LiveBench::isProbeOn() const {
    return probe_ != nullptr && *probe_;
}

bool LiveBench::isHomeSwitchOn(int joint) const {
    const volatile bool *const level = home_switches_[static_cast<std::size_t>(joint)];
    return level != nullptr && *level;
}

JointReading LiveBench::joint(int joint) const {
    const messages::JointStatus &status = client_.status().joints[static_cast<std::size_t>(joint)];
    return {.command = status.pos_cmd,
            .feedback = status.pos_fb,
            .isHomeSwitchOn = isHomeSwitchOn(joint),
            .isMoving = status.vel_cmd != 0 || status.isHoming,
            .isHoming = status.isHoming,
            .isHomed = status.isHomed,
            .isDriveFaulted = status.isFaulted,
            .isFollowingErrorTripped = status.isFerrorTripped};
}

std::uint64_t LiveBench::late_cycles() const {
    std::uint64_t late = 0;
    for (const hal::ThreadInfo &thread : hal_.threads()) {
        late += thread.overruns;
    }
    return late;
}

double LiveBench::worst_latency_s() const {
    std::int64_t worst_ns = 0;
    for (const hal::ThreadInfo &thread : hal_.threads()) {
        worst_ns = std::max(worst_ns, thread.max_latency_ns);
    }
    constexpr double S_PER_NS = 1e-9;
    return static_cast<double>(worst_ns) * S_PER_NS;
}

void LiveBench::post(const messages::Command &command) {
    waiting_.clear();
    posted_.reset();
    static_cast<void>(client_.post(command));
}

void LiveBench::post_waiting() {
    if (posted_.has_value()) {
        const client::Outcome outcome = client_.outcome(*posted_);
        if (outcome.progress == messages::Progress::STARTED) {
            return;
        }
        posted_.reset();
        if (outcome.progress != messages::Progress::DONE) {
            waiting_.clear();
            last_error_ = last_error_.empty() ? outcome.reason : last_error_;
        }
    }
    if (!waiting_.empty()) {
        const auto posted = client_.post(waiting_.front());
        waiting_.pop_front();
        posted_ = posted.has_value() ? std::optional(*posted) : std::nullopt;
    }
}

void LiveBench::close_gate(int joint) {
    const auto output = hal_.pin(fmt::format("joint.{}.amp-enable-out", joint));
    if (!output.has_value() || output->signal.empty()) {
        return;
    }
    for (const hal::PinInfo &pin : hal_.pins()) {
        if (pin.signal == output->signal && pin.dir == hal::Dir::IN) {
            gates_.push_back({joint, pin.name, pin.signal});
            static_cast<void>(hal_.unlink(pin.name));
            static_cast<void>(hal_.set(pin.name, hal::Value::of_bit(false)));
        }
    }
}

void LiveBench::open_gates() {
    for (const Gate &gate : gates_) {
        static_cast<void>(hal_.link(gate.pin, gate.signal));
    }
    gates_.clear();
}

void LiveBench::switch_on(const std::vector<int> &joints) {
    last_error_.clear();
    open_gates();
    for (int one = 0; one < joints_; ++one) {
        if (std::ranges::find(joints, one) == joints.end()) {
            close_gate(one);
        }
    }
    posted_.reset();
    waiting_ = {messages::SetState{messages::State::ESTOP_RESET}, messages::SetMode{messages::Mode::MANUAL},
                messages::SetState{messages::State::ON}, messages::SetTeleop{false}};
}

void LiveBench::switch_off() {
    post(messages::AbortAll{});
    post(messages::SetState{messages::State::OFF});
}

void LiveBench::move(int joint, double distance, double speed) {
    post(messages::JogIncrement{true, joint, std::abs(speed), distance});
}

void LiveBench::stop(int joint) {
    if (client_.status().joints[static_cast<std::size_t>(joint)].isHoming) {
        post(messages::AbortAll{});
    } else {
        post(messages::JogStop{true, joint});
    }
}

void LiveBench::home(int joint) {
    post(messages::HomeJoint{joint});
}

void LiveBench::unhome(int joint) {
    post(messages::UnhomeJoint{joint});
}

void LiveBench::run_spindle(double speed_rpm) {
    post(messages::SpindleOn{0, speed_rpm});
}

void LiveBench::stop_spindle() {
    post(messages::SpindleOff{0});
}

std::optional<double> LiveBench::value(std::string_view name) const {
    const auto value = hal_.get(name);
    return value.has_value() ? std::optional(value->as_number()) : std::nullopt;
}

void LiveBench::set_value(std::string_view name, double value) {
    const auto current = hal_.get(name);
    if (!current.has_value()) {
        return;
    }
    const std::string text =
        current->type == hal::Type::FLOAT || current->type == hal::Type::BIT
            ? fmt::format("{}", current->type == hal::Type::BIT ? (value != 0 ? 1.0 : 0.0) : value)
            : fmt::format("{}", std::llround(value));
    static_cast<void>(hal_.set(name, text));
}

}  // namespace mw::commissioning
