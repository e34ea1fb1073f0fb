// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/remote/remote_machine.hh"

#include <signal.h>
#include <time.h>

#include <algorithm>
#include <chrono>

#include <fmt/format.h>

#include "clients/nml/bridge/bridge.hh"
#include "messages/declarations/catalogue.hh"

namespace mw::nml {
namespace {

constexpr std::int64_t NS_PER_S = 1000000000;
/// Time between two reads of the status.
constexpr std::chrono::milliseconds PERIOD{10};
/// A connection without a new status for this time counts as lost.
constexpr std::int64_t STATUS_LIMIT_NS = 3 * NS_PER_S;
/// Motion ends a jog that is not renewed within this time.
constexpr int LEASE_MS = 500;
constexpr std::int64_t RENEWAL_NS = NS_PER_S / 10;
constexpr int MESSAGES_PER_STEP = 16;

std::int64_t now_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

bool is_same(const messages::JogContinuous &jog, bool is_joint, int index) {
    return jog.isJoint == is_joint && jog.index == index;
}

}  // namespace

RemoteMachine::RemoteMachine(Config config, std::string process)
    : config_(std::move(config)), process_(std::move(process)) {
    const BufferSettings *const status = config_.find_buffer(STATUS_CHANNEL);
    if (status != nullptr) {
        const int port = status->tcp_port.value_or(status->stcp_port.value_or(status->udp_port.value_or(0)));
        server_ = fmt::format("{}:{}", status->host, port);
    }
}

Result<std::shared_ptr<RemoteMachine>> RemoteMachine::connect(Config config, const std::string &process,
                                                              mailbox::Serial serial) {
    std::shared_ptr<RemoteMachine> made(new RemoteMachine(std::move(config), process));
    made->segment().serials.store(serial);
    auto opened = made->open();
    if (opened.has_value()) {
        opened = made->wait_first_status();
    }
    if (!opened.has_value()) {
        Error error = opened.error();
        error.message = fmt::format("NML server {}: {}", made->server_, error.message);
        return std::unexpected(std::move(error));
    }
    made->thread_ = std::thread([machine = made.get()] {
        // Signals are handled by the threads of the program.
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
        machine->run();
    });
    return made;
}

RemoteMachine::~RemoteMachine() {
    is_ending_.store(true);
    command_posted();
    if (thread_.joinable()) {
        thread_.join();
    }
}

Result<> RemoteMachine::open() {
    const BufferSettings *const commands = config_.find_buffer(COMMAND_CHANNEL);
    if (commands != nullptr && (!commands->is_queue || !commands->isNumbered)) {
        return fail(
            fmt::format("buffer '{}': a remote client needs a queue with serial numbers", COMMAND_CHANNEL),
            commands->place, "Add the options queue and serial to the B line.");
    }
    const Connections connections{config_, process_, "", vocabulary_, local_};
    for (auto &[name, channel] :
         {std::pair<const char *, std::optional<Channel> *>{STATUS_CHANNEL, &statuses_},
          {COMMAND_CHANNEL, &commands_},
          {ERROR_CHANNEL, &errors_},
          {TOOL_CHANNEL, &tools_}}) {
        const bool is_optional = channel == &tools_;
        if (is_optional &&
            (config_.find_buffer(name) == nullptr || config_.find_process(process_, name) == nullptr)) {
            continue;
        }
        auto opened = Channel::open(connections, name);
        if (!opened.has_value()) {
            return std::unexpected(opened.error());
        }
        channel->emplace(std::move(*opened));
    }
    return {};
}

Result<> RemoteMachine::wait_first_status() {
    // The first status may be the last one of a machine that has ended, because it remains in the buffer.
    constexpr int LIVING = 2;
    const std::int64_t end_ns = now_ns() + STATUS_LIMIT_NS;
    for (int count = 0; true;) {
        const auto found = read_status();
        if (!found.has_value()) {
            return std::unexpected(found.error());
        }
        count += *found ? 1 : 0;
        if (count == LIVING) {
            return read_tools();
        }
        if (now_ns() > end_ns) {
            return fail("its machine sends no status", {}, "Is the machine running on that computer?");
        }
        std::this_thread::sleep_for(PERIOD);
    }
}

Result<> RemoteMachine::check() const {
    {
        const std::lock_guard lock(mutex_);
        if (lost_.has_value()) {
            return std::unexpected(*lost_);
        }
    }
    if (now_ns() - status_ns_.load() > STATUS_LIMIT_NS) {
        return fail(fmt::format("NML server {}: no status for {} s", server_, STATUS_LIMIT_NS / NS_PER_S), {},
                    "Check the network and the machine.");
    }
    return {};
}

Result<> RemoteMachine::check_tools() const {
    return tools_.has_value() ? Result<>{}
                              : fail(fmt::format("the tool table of the machine at {} is not available: the "
                                                 "NML file has no buffer {} for process '{}'",
                                                 server_, TOOL_CHANNEL, process_),
                                     {}, "Add it on both computers, see the page on NML.");
}

void RemoteMachine::command_posted() {
    {
        const std::lock_guard lock(mutex_);
        is_posted_ = true;
    }
    wake_.notify_one();
}

void RemoteMachine::run() {
    bool is_lost = false;
    while (!is_ending_.load()) {
        if (!is_lost) {
            const auto stepped = step();
            if (!stepped.has_value()) {
                lose(stepped.error());
                is_lost = true;
            }
        } else {
            for (const auto &delivery : desk_.take(now_ns())) {
                desk_.tell(delivery.serial, messages::Progress::REFUSED, check().error().str());
            }
        }
        std::unique_lock lock(mutex_);
        wake_.wait_for(lock, PERIOD, [this] { return is_posted_; });
        is_posted_ = false;
    }
    if (!is_lost) {  // sends commands that clients have posted before they left
        static_cast<void>(send_commands());
    }
}

Result<> RemoteMachine::step() {
    auto done = send_commands();
    done = done.has_value() ? send_renewals() : done;
    if (!done.has_value()) {
        return done;
    }
    const auto found = read_status();
    if (!found.has_value()) {
        return std::unexpected(found.error());
    }
    if (now_ns() - status_ns_.load() > STATUS_LIMIT_NS) {
        return fail("its machine sends no status", {}, "Is the machine running on that computer?");
    }
    done = read_messages();
    return done.has_value() ? read_tools() : done;
}

Result<> RemoteMachine::send_commands() {
    auto taken = desk_.take(now_ns());
    for (auto delivery = taken.begin(); delivery != taken.end(); ++delivery) {
        note_jog(delivery->command);
        const auto number = send(delivery->command);
        if (!number.has_value()) {
            for (; delivery != taken.end(); ++delivery) {
                desk_.tell(delivery->serial, messages::Progress::FAILED, number.error().str());
            }
            return std::unexpected(number.error());
        }
        pending_[*number] = delivery->serial;
    }
    return {};
}

Result<WriteNumber> RemoteMachine::send(messages::Command &command) {
    CommandHead head;
    return commands_->write({messages::object(head), messages::object(command)});
}

void RemoteMachine::note_jog(messages::Command &command) {
    const auto forget = [this](bool is_joint, int index) {
        std::erase_if(jogs_, [&](const Jog &jog) { return is_same(jog.command, is_joint, index); });
    };
    if (auto *const jog = std::get_if<messages::JogContinuous>(&command)) {
        forget(jog->isJoint, jog->index);
        if (jog->lease_ms == 0) {
            jog->lease_ms = LEASE_MS;
            jogs_.push_back({*jog, now_ns(), 0});
            jogs_.back().command.isRenewal = true;
        }
    } else if (const auto *const stop = std::get_if<messages::JogStop>(&command)) {
        forget(stop->isJoint, stop->index);
    }
}

Result<> RemoteMachine::send_renewals() {
    for (Jog &jog : jogs_) {
        if (now_ns() - jog.renewed_ns < RENEWAL_NS) {
            continue;
        }
        messages::Command renewal = jog.command;
        const auto number = send(renewal);
        if (!number.has_value()) {
            return std::unexpected(number.error());
        }
        jog.number = *number;
        jog.renewed_ns = now_ns();
    }
    return {};
}

Result<bool> RemoteMachine::read_status() {
    auto message = statuses_->read();
    if (!message.has_value()) {
        return std::unexpected(message.error());
    }
    if (!message->has_value()) {
        return false;
    }
    const auto *const status = (*message)->get<messages::MachineStatus>();
    const StatusHead *const head = (*message)->status_head();
    if (status == nullptr || head == nullptr) {
        return fail(fmt::format("buffer '{}' has a message that is no status of a machine", STATUS_CHANNEL));
    }
    status_ns_.store(now_ns());
    follow(*head);
    publish(*status);
    return true;
}

void RemoteMachine::follow(const StatusHead &head) {
    const auto find = [&head](WriteNumber number) {
        const auto found = std::find_if(head.recent.begin(), head.recent.end(),
                                        [number](const auto &one) { return one.serial_number == number; });
        return found == head.recent.end() ? nullptr : &*found;
    };
    std::erase_if(jogs_, [&](const Jog &jog) {  // a limit, a stop or another client has ended the jog
        const CommandOutcome *const renewal = jog.number != 0 ? find(jog.number) : nullptr;
        return renewal != nullptr && renewal->state == CommandState::ERROR;
    });
    for (auto one = pending_.begin(); one != pending_.end() && one->first <= head.echo_serial_number;) {
        const auto [number, serial] = *one;
        const CommandOutcome *const outcome = find(number);
        taken_ = std::max(taken_, serial);
        if (outcome != nullptr && outcome->state == CommandState::EXECUTING) {
            ++one;
            continue;
        }
        const bool is_done = outcome != nullptr && outcome->state == CommandState::DONE;
        desk_.tell(serial, is_done ? messages::Progress::DONE : messages::Progress::FAILED,
                   outcome != nullptr ? outcome->reason.str()
                                      : "the outcome is not known: many other commands were sent meanwhile");
        one = pending_.erase(one);
    }
}

void RemoteMachine::publish(messages::MachineStatus status) {
    status.last_command = taken_;
    status.last_message = desk_.newest_message();
    segment().status.write(status, messages::PublishedStatus::ALL);
    segment().cycles.store(++cycles_, std::memory_order_release);
    mailbox::Memory::ring(segment());
}

Result<> RemoteMachine::read_messages() {
    for (int i = 0; i < MESSAGES_PER_STEP && are_messages_requested_.load(); ++i) {
        auto message = errors_->read();
        if (!message.has_value()) {
            return std::unexpected(message.error());
        }
        if (!message->has_value()) {
            return {};
        }
        if (const auto *const error = (*message)->get<messages::OperatorError>()) {
            desk_.post(messages::MessageKind::OPERATOR_ERROR, error->text);
        } else if (const auto *const text = (*message)->get<messages::OperatorText>()) {
            desk_.post(messages::MessageKind::OPERATOR_TEXT, text->text);
        } else if (const auto *const display = (*message)->get<messages::OperatorDisplay>()) {
            desk_.post(messages::MessageKind::OPERATOR_DISPLAY, display->text);
        }
    }
    return {};
}

Result<> RemoteMachine::read_tools() {
    if (!tools_.has_value()) {
        return {};
    }
    auto message = tools_->read();
    if (!message.has_value()) {
        return std::unexpected(message.error());
    }
    if (message->has_value()) {
        if (const auto *const table = (*message)->get<messages::ToolTable>()) {
            desk_.publish_tools(*table);
        }
    }
    return {};
}

void RemoteMachine::lose(const Error &error) {
    Error told = error;
    told.message = fmt::format("connection to NML server {} is lost: {}", server_, error.message);
    for (const auto &[number, serial] : pending_) {
        desk_.tell(serial, messages::Progress::FAILED, told.str());
    }
    pending_.clear();
    jogs_.clear();
    {
        const std::lock_guard lock(mutex_);
        lost_ = std::move(told);
    }
    mailbox::Memory::ring(segment());
}

}  // namespace mw::nml
