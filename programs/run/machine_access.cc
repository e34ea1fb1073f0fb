// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/machine_access.hh"

#include <chrono>

#include <fmt/format.h>

#include "base/stop_signals.hh"
#include "base/whole_path.hh"

namespace mw::programs {
namespace {

constexpr std::int64_t STOP_TIMEOUT_NS = 30000000000;
/// Maximum wait, because a tap or thread pauses only at its end.
constexpr std::int64_t HOLD_TIMEOUT_NS = 1000000000;
/// A client that hangs for longer loses the exclusive right to operate.
constexpr double LEASE_S = 5.0;
constexpr std::int64_t RENEW_EVERY_NS = 1000000000;
/// Maximum wait for an answer; task's cycles take milliseconds.
constexpr double ANSWER_S = 5.0;
constexpr double CYCLE_S = 0.1;
/// HAL files and their programs may take long.
constexpr auto START_TIME = std::chrono::seconds(30);

/// Reads the current status. Returns false if there is none.
bool isMoving(client::Client &client) {
    return client.read_status().has_value() && client.status().trajectory.isEnabled &&
           !client.status().trajectory.isInPosition;
}

/// True if the axes are stopped within their path, so that only a resume moves them.
bool isHeldAtRest(client::Client &client) {
    return client.read_status().has_value() && client.status().trajectory.isPaused &&
           client.status().trajectory.current_velocity == 0.0;
}

void wait_for_rest(MachineAccess &machine, std::int64_t most_ns) {
    const std::int64_t deadline_ns = machine.now_ns() + most_ns;
    machine.cycle();
    machine.cycle();
    while (isMoving(machine.client()) && !isHeldAtRest(machine.client()) && machine.now_ns() < deadline_ns &&
           machine.health()) {
        machine.cycle();
    }
}

}  // namespace

Result<std::unique_ptr<RunningMachine>> RunningMachine::find(const std::string &instance,
                                                             const std::string &ini) {
    auto client = client::Client::connect(instance, client::Role::ATTENDED);
    if (!client.has_value()) {
        return nullptr;
    }
    mailbox::Identity identity = client->identity();
    const auto begin = std::chrono::steady_clock::now();
    while (identity.ini.empty() && std::chrono::steady_clock::now() - begin < START_TIME &&
           client->isMachineAlive() && stop_signal == 0) {
        static_cast<void>(client->wait_status(CYCLE_S));
        identity = client->identity();
    }
    if (identity.ini.empty()) {
        return fail(fmt::format("the machine of instance '{}' does not become ready", instance));
    }
    if (!identity.isLasting) {
        return fail(
            fmt::format("instance '{}' runs a program on its own machine: {}", instance, identity.ini.str()),
            {}, "wait for its end; 'millwright start' runs a machine that programs share");
    }
    if (identity.ini.str() != whole_path(ini)) {
        return fail(fmt::format("the machine that runs as instance '{}' was started from {}, not from {}",
                                instance, identity.ini.str(), ini));
    }
    return std::unique_ptr<RunningMachine>(new RunningMachine(std::move(*client)));
}

RunningMachine::~RunningMachine() {
    give_back();
}

Result<> RunningMachine::check_idle() {
    const auto read = client_.read_status();
    if (!read.has_value()) {
        return read;
    }
    const messages::MachineStatus &status = client_.status();
    if (status.task.interp_state != messages::InterpState::IDLE) {
        return fail("the machine is already running a program or an MDI line", {},
                    status.task.program.empty() ? "" : "the open program is " + status.task.program.str());
    }
    if (status.trajectory.isEnabled && (status.trajectory.isHoming || !status.trajectory.isInPosition)) {
        return fail("the machine is moving: a jog or homing is active");
    }
    return {};
}

Result<> RunningMachine::ask(const messages::Command &command) {
    const auto posted = client_.post(command);
    if (!posted.has_value()) {
        return std::unexpected(posted.error());
    }
    const auto outcome = client_.wait(*posted, ANSWER_S);
    if (!outcome.has_value()) {
        return fail("the machine does not answer: " + outcome.error().message);
    }
    return outcome->progress == messages::Progress::DONE ? Result<>{} : fail(outcome->reason);
}

Result<> RunningMachine::take_over() {
    auto status = check_idle();
    status = status.has_value() ? ask(messages::ClaimOperation{LEASE_S}) : status;
    if (!status.has_value()) {
        return status;
    }
    operate_right_owned_ = true;
    renewed_ns_ = now_ns();
    // another client may have started something before this one had the right to operate
    status = check_idle();
    if (!status.has_value()) {
        give_back();
    }
    return status;
}

void RunningMachine::give_back() {
    if (operate_right_owned_ && !gone_) {
        static_cast<void>(ask(messages::ReleaseOperation{}));
    }
    operate_right_owned_ = false;
}

void RunningMachine::cycle() {
    if (!client_.wait_status(CYCLE_S).has_value()) {
        gone_ = !client_.isMachineAlive();
    }
    const std::int64_t now = now_ns();
    if (operate_right_owned_ && !gone_ && now - renewed_ns_ >= RENEW_EVERY_NS) {
        renewed_ns_ = now;
        static_cast<void>(client_.post(messages::ClaimOperation{LEASE_S}));
    }
}

std::int64_t RunningMachine::now_ns() const {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

Result<> RunningMachine::health() const {
    return gone_ ? fail("the machine is no longer running: 'millwright start' has ended") : Result<>{};
}

void stop_motion(MachineAccess &machine) {
    static_cast<void>(machine.client().post(messages::AbortAll{}));
    wait_for_rest(machine, STOP_TIMEOUT_NS);
}

void switch_off(MachineAccess &machine) {
    // An abort would switch the spindle off at once, while the tool still moves through the part.
    const bool running = machine.client().read_status().has_value() &&
                         machine.client().status().task.interp_state != messages::InterpState::IDLE;
    if (running && machine.client().post(messages::PauseProgram{}).has_value()) {
        wait_for_rest(machine, HOLD_TIMEOUT_NS);
    }
    stop_motion(machine);
    static_cast<void>(machine.client().post(messages::SetState{messages::State::ESTOP}));
    for (int i = 0; i < 3; ++i) {
        machine.cycle();
    }
}

}  // namespace mw::programs
