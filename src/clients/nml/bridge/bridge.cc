// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/nml/bridge/bridge.hh"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "messages/declarations/catalogue.hh"
#include "messages/declarations/check.hh"
#include "messages/mailbox/stops.hh"

namespace mw::nml {
namespace {

/// Maximum number of commands that the mailbox takes from one client in a cycle.
constexpr int COMMANDS_PER_STEP = mailbox::MAX_POSTED;
/// Maximum number of commands sent before the start.
constexpr int MOST_OLD_COMMANDS = 1000000;
/// Maximum number of lines for the operator that wait for space; the oldest lines are lost first.
constexpr std::size_t MAX_LINES = 256;

CommandState state_of(messages::Progress progress) {
    switch (progress) {
    case messages::Progress::STARTED: return CommandState::EXECUTING;
    case messages::Progress::DONE: return CommandState::DONE;
    case messages::Progress::REFUSED:
    case messages::Progress::FAILED: break;
    }
    return CommandState::ERROR;
}

template <class Text>
Result<WriteNumber> write_line(Channel &channel, std::uint64_t number, const std::string &text) {
    CommandMessage<Text> line{{number}, {text.substr(0, messages::MAX_TEXT)}};
    return channel.write(view(line), AT_ONCE);  // a reader may hold the lock, so the next step tries again
}

Result<WriteNumber> write_line(Channel &channel, messages::MessageKind kind, std::uint64_t number,
                               const std::string &text) {
    switch (kind) {
    case messages::MessageKind::OPERATOR_ERROR:
        return write_line<messages::OperatorError>(channel, number, text);
    case messages::MessageKind::OPERATOR_TEXT:
        return write_line<messages::OperatorText>(channel, number, text);
    case messages::MessageKind::OPERATOR_DISPLAY: break;
    }
    return write_line<messages::OperatorDisplay>(channel, number, text);
}

}  // namespace

Bridge::Bridge(Channel commands, Channel status, Channel errors, client::Client &client)
    : commands_(std::move(commands)), statuses_(std::move(status)), errors_(std::move(errors)),
      client_(client), status_(std::make_unique<StatusMessage<messages::MachineStatus>>()) {}

Result<std::unique_ptr<Bridge>> Bridge::open(const Connections &connections, client::Client &client) {
    auto commands = Channel::open(connections, COMMAND_CHANNEL);
    auto status = Channel::open(connections, STATUS_CHANNEL);
    auto errors = Channel::open(connections, ERROR_CHANNEL);
    for (const auto *channel : {&commands, &status, &errors}) {
        if (!channel->has_value()) {
            return std::unexpected(channel->error());
        }
    }
    std::unique_ptr<Bridge> bridge(
        new Bridge(std::move(*commands), std::move(*status), std::move(*errors), client));
    if (connections.config.find_buffer(TOOL_CHANNEL) != nullptr &&
        connections.config.find_process(connections.process, TOOL_CHANNEL) != nullptr) {
        auto tools = Channel::open(connections, TOOL_CHANNEL);
        if (!tools.has_value()) {
            return std::unexpected(tools.error());
        }
        bridge->tools_.emplace(std::move(*tools));
    }
    const auto dropped = bridge->drop_old_commands();
    return dropped.has_value() ? Result<std::unique_ptr<Bridge>>(std::move(bridge))
                               : std::unexpected(dropped.error());
}

Result<> Bridge::drop_old_commands() {
    for (int count = 0;; ++count) {
        Received received;
        const auto found = commands_.receive(received);
        if (!found.has_value()) {
            return std::unexpected(found.error());
        }
        if (!*found || count >= MOST_OLD_COMMANDS) {
            if (count > 0) {
                keep_message(
                    messages::MessageKind::OPERATOR_ERROR, 0,
                    fmt::format(
                        "{} commands are dropped: they were sent before the machine's channels were up",
                        count));
            }
            return *found
                       ? fail(fmt::format("{} is written to faster than it can be emptied", COMMAND_CHANNEL))
                       : Result<>{};
        }
    }
}

Result<> Bridge::step(Clock::time_point now) {
    is_late_ = is_late_ || (last_step_.has_value() && now - *last_step_ > STALL_LIMIT);
    last_step_ = now;
    const auto taken = take_commands();
    post_own();
    follow();
    while (const auto message = client_.next_message()) {
        keep_message(message->kind, message->number, message->text);
    }
    const auto told = tell_messages();
    const auto tools = publish_tools();
    const auto published = publish();
    for (const auto *part : {&taken, &told, &tools}) {
        if (!part->has_value()) {
            return *part;
        }
    }
    return published;
}

void Bridge::add(std::vector<messages::Command> commands) {
    std::move(commands.begin(), commands.end(), std::back_inserter(own_));
}

/// The mailbox always has space for a stop.
void Bridge::post_own() {
    if (emptied_) {
        for (const messages::Command &command : std::exchange(own_, {})) {
            static_cast<void>(client_.post(command));
        }
    }
}

Result<> Bridge::take_commands() {
    emptied_ = false;
    for (int i = 0; i < COMMANDS_PER_STEP; ++i) {
        if (!held_.has_value()) {
            auto next = next_command();
            if (!next.has_value()) {
                return std::unexpected(next.error());
            }
            held_ = std::move(*next);
        }
        is_late_ = is_late_ && held_.has_value();
        emptied_ = !held_.has_value();
        if (!held_.has_value() || !post(*held_)) {
            return {};
        }
        held_.reset();
    }
    return {};
}

/// The next command; nothing when there is none, or none that a machine may execute.
Result<std::optional<Bridge::Held>> Bridge::next_command() {
    for (int i = 0; i < COMMANDS_PER_STEP; ++i) {
        Received received;
        const auto found = commands_.receive(received);
        if (!found.has_value()) {
            return std::unexpected(found.error());
        }
        if (!*found) {
            return std::nullopt;
        }
        auto message = commands_.codec().decode(received.bytes);
        StatusHead head;
        head.echo_serial_number = commands_.isNumbered() ? received.number : 0;
        if (message.has_value() && message->command_head() != nullptr) {
            head.command_type = message->number();
            head.state = CommandState::EXECUTING;
            head.echo_serial_number =
                commands_.isNumbered() ? received.number : message->command_head()->serial_number;
        }
        auto command = message.has_value() ? message->command() : std::unexpected(message.error());
        if (command.has_value()) {
            return std::optional(Held{std::move(*command), head});
        }
        refuse(head, command.error().str());
    }
    return std::nullopt;
}

bool Bridge::post(const Held &held) {
    const auto allowed = messages::check(held.command);
    if (!allowed.has_value()) {
        refuse(held.head, allowed.error().str());
        return true;
    }
    if (is_late_ && !mailbox::isStop(held.command)) {
        refuse(held.head, "the NML server did not run while the command waited: send it again");
        return true;
    }
    const auto serial = client_.post(held.command);
    if (!serial.has_value()) {
        return false;
    }
    waiting_.push_back({held.head, *serial});
    return true;
}

void Bridge::refuse(StatusHead head, const std::string &reason) {
    head.state = CommandState::ERROR;
    head.reason.assign(reason);
    waiting_.push_back({head, 0});
    keep_message(messages::MessageKind::OPERATOR_ERROR, 0, reason);
}

void Bridge::note_taken() {
    while (!waiting_.empty() && waiting_.front().posted <= client_.status().last_command) {
        note(waiting_.front().head, waiting_.front().posted);
        waiting_.pop_front();
    }
}

void Bridge::note(const StatusHead &head, client::Serial posted) {
    auto &recent = head_.recent;
    const auto is_replaced_before = [](const CommandOutcome &a, const CommandOutcome &b) {
        const bool is_a_ended = a.state != CommandState::EXECUTING;
        const bool is_b_ended = b.state != CommandState::EXECUTING;
        return is_a_ended != is_b_ended ? is_a_ended : a.serial_number < b.serial_number;
    };
    auto *const place = std::min_element(recent.begin(), recent.end(), is_replaced_before);
    *place = {head.echo_serial_number, head.state, head.reason};
    posted_[static_cast<std::size_t>(place - recent.begin())] = posted;
    head_.command_type = head.command_type;
    head_.echo_serial_number = head.echo_serial_number;
    head_.state = head.state;
    head_.reason = head.reason;
    head_new_ = true;
}

void Bridge::follow() {
    for (std::size_t i = 0; i < posted_.size(); ++i) {
        if (posted_[i] == 0) {
            continue;
        }
        const client::Outcome outcome = client_.outcome(posted_[i]);
        if (outcome.progress == messages::Progress::STARTED) {
            continue;
        }
        posted_[i] = 0;
        CommandOutcome &ended = head_.recent[i];
        ended.state = state_of(outcome.progress);
        ended.reason.assign(outcome.reason);
        if (ended.serial_number == head_.echo_serial_number) {
            head_.state = ended.state;
            head_.reason = ended.reason;
        }
        head_new_ = true;
    }
}

Result<> Bridge::publish_tools() {
    if (!tools_.has_value()) {
        return {};
    }
    auto newer = client_.read_tools();
    if (!newer.has_value()) {
        return std::unexpected(newer.error());
    }
    if (newer->has_value()) {
        table_ = {{}, std::move(**newer)};
    }
    if (!table_.has_value()) {
        return {};
    }
    const auto written = tools_->write(view(*table_));
    if (!written.has_value()) {
        return std::unexpected(written.error());
    }
    table_.reset();
    return {};
}

Result<> Bridge::publish() {
    const auto read = client_.read_status();
    if (!read.has_value()) {
        return read;
    }
    note_taken();
    if (client_.status().cycle == published_cycle_ && !head_new_) {
        return {};
    }
    status_->head = head_;
    status_->body = client_.status();
    const auto written = statuses_.write(view(*status_));
    if (!written.has_value()) {
        return std::unexpected(written.error());
    }
    published_cycle_ = status_->body.cycle;
    head_new_ = false;
    return {};
}

void Bridge::keep_message(messages::MessageKind kind, std::uint64_t number, const std::string &text) {
    if (lines_.size() >= MAX_LINES) {
        lines_.pop_front();
        ++lost_lines_;
    }
    lines_.push_back({kind, number, text});
}

/// Writes messages for the operator. A full queue is not an error, because there may be no reader.
Result<> Bridge::tell_messages() {
    if (lost_lines_ > 0 &&
        write_line(errors_, messages::MessageKind::OPERATOR_TEXT, 0,
                   fmt::format("{} messages were lost because no client read them", lost_lines_))
            .has_value()) {
        lost_lines_ = 0;
    }
    while (!lines_.empty() &&
           write_line(errors_, lines_.front().kind, lines_.front().number, lines_.front().text).has_value()) {
        lines_.pop_front();
    }
    return {};
}

}  // namespace mw::nml
