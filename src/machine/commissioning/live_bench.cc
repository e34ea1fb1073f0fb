// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/commissioning/live_bench.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mw::commissioning {

std::vector<std::string> watchdog_commands() {
    constexpr double TIMEOUT_S = 0.25;
    return {"loadrt watchdog num_inputs=1", "addf watchdog.process servo-thread",
            "addf watchdog.set-timeouts servo-thread", fmt::format("setp watchdog.timeout-0 {}", TIMEOUT_S),
            "net commissioning-alive watchdog.ok-out => motion.enable"};
}

LiveBench::LiveBench(client::Client &client, hal::Instance &hal, int joints)
    : client_(client), hal_(hal), joints_(joints) {
    estop_ = find_bit(hal.signals().has("estop-released") ? "estop-released" : "iocontrol.0.emc-enable-in");
    probe_ = find_bit("motion.probe-input");
    watchdog_beat_ = find_bit("watchdog.input-0");
    watchdog_enable_ = find_bit("watchdog.enable-in");
    for (int joint = 0; joint < joints; ++joint) {
        home_switches_.push_back(find_bit(fmt::format("joint.{}.home-sw-in", joint)));
    }
}

volatile bool *LiveBench::find_bit(const std::string &name) {
    const auto address = hal_.values().address_of(name, hal::Type::BIT);
    return address.has_value() ? static_cast<volatile bool *>(*address) : nullptr;
}

void LiveBench::update() {
    static_cast<void>(client_.read_status());
    while (const auto message = client_.next_message()) {
        if (message->kind == messages::MessageKind::OPERATOR_ERROR) {
            last_error_ = message->text;
        }
    }
    if (hasWatchdog()) {
        *watchdog_beat_ = !*watchdog_beat_;
        // The watchdog is enabled only here, not after a pause of this program.
        *watchdog_enable_ = !std::exchange(isRestartingWatchdog_, false);
    }
    post_waiting();
}

double LiveBench::now_s() const {
    constexpr double S_PER_NS = 1e-9;
    return static_cast<double>(hal_.now_ns()) * S_PER_NS;
}

bool LiveBench::isOn() const {
    const bool is_switching = posted_.has_value() || !waiting_.empty();
    return !is_switching && client_.status().task.state == messages::State::ON &&
           client_.status().trajectory.isEnabled;
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
    for (const hal::ThreadInfo &thread : hal_.threads().list()) {
        late += thread.overruns;
    }
    return late;
}

double LiveBench::worst_latency_s() const {
    std::int64_t worst_ns = 0;
    for (const hal::ThreadInfo &thread : hal_.threads().list()) {
        worst_ns = std::max(worst_ns, thread.max_latency_ns);
    }
    constexpr double S_PER_NS = 1e-9;
    return static_cast<double>(worst_ns) * S_PER_NS;
}

void LiveBench::post(const messages::Command &command) {
    waiting_.clear();
    posted_.reset();
    if (const auto posted = client_.post(command); !posted.has_value()) {
        last_error_ = posted.error().str();
    }
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
        if (!posted.has_value()) {
            waiting_.clear();
            last_error_ = posted.error().str();
        }
    }
}

Result<> LiveBench::close_gate(int joint) {
    const auto output = hal_.pins().find(fmt::format("joint.{}.amp-enable-out", joint));
    if (!output.has_value() || output->signal.empty()) {
        return {};
    }
    for (const hal::PinInfo &pin : hal_.pins().list()) {
        if (pin.signal == output->signal && pin.dir == hal::Dir::IN) {
            auto done = hal_.signals().unlink(pin.name);
            if (done.has_value()) {
                gates_.push_back({joint, pin.name, pin.signal});
                done = hal_.values().set(pin.name, hal::Value::of_bit(false));
            }
            if (!done.has_value()) {
                return done;
            }
        }
    }
    return {};
}

Result<> LiveBench::open_gates() {
    for (; !gates_.empty(); gates_.pop_back()) {
        if (auto done = hal_.signals().link(gates_.back().pin, gates_.back().signal); !done.has_value()) {
            return done;
        }
    }
    return {};
}

Result<> LiveBench::close_gates_except(const std::vector<int> &joints) {
    auto done = open_gates();
    for (int one = 0; one < joints_ && done.has_value(); ++one) {
        done = std::ranges::find(joints, one) == joints.end() ? close_gate(one) : done;
    }
    return done;
}

void LiveBench::switch_on(const std::vector<int> &joints) {
    last_error_.clear();
    posted_.reset();
    waiting_.clear();
    homing_joint_ = NO_JOINT;
    if (!hasWatchdog()) {
        last_error_ = "the machine has no commissioning watchdog";
        return;
    }
    // If a drive cannot be kept off, the machine is not switched on.
    if (const auto gated = close_gates_except(joints); !gated.has_value()) {
        last_error_ = gated.error().str();
        return;
    }
    isRestartingWatchdog_ = true;
    waiting_ = {messages::SetState{messages::State::ESTOP_RESET}, messages::SetMode{messages::Mode::MANUAL},
                messages::SetState{messages::State::ON}, messages::SetTeleop{false}};
}

void LiveBench::switch_off() {
    post(messages::AbortAll{});
    post(messages::SetState{messages::State::OFF});
}

void LiveBench::move_to(int joint, double position, double speed) {
    homing_joint_ = NO_JOINT;
    post(messages::JogAbsolute{true, joint, std::abs(speed), position});
}

void LiveBench::stop(int joint) {
    // The status may not show a requested homing yet.
    if (joint == homing_joint_ || client_.status().joints[static_cast<std::size_t>(joint)].isHoming) {
        post(messages::AbortAll{});
    } else {
        post(messages::JogStop{true, joint});
    }
}

void LiveBench::home(int joint) {
    homing_joint_ = joint;
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
    const auto value = hal_.values().get(name);
    return value.has_value() ? std::optional(value->as_number()) : std::nullopt;
}

void LiveBench::set_value(std::string_view name, double value) {
    const auto current = hal_.values().get(name);
    if (!current.has_value()) {
        return reject(current.error().str());
    }
    const bool is_bit = current->type == hal::Type::BIT;
    const std::string text = is_bit                              ? std::string(value != 0 ? "1" : "0")
                             : current->type == hal::Type::FLOAT ? fmt::format("{}", value)
                                                                 : fmt::format("{}", std::llround(value));
    if (const auto done = hal_.values().set(name, text); !done.has_value()) {
        reject(done.error().str());
    }
}

void LiveBench::reject(std::string why) {
    switch_off();
    last_error_ = std::move(why);
}

}  // namespace mw::commissioning
