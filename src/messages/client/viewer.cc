// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/client/viewer.hh"

#include <time.h>
#include <unistd.h>

#include <algorithm>

#include <fmt/format.h>

#include "base/duration.hh"
#include "messages/declarations/binary.hh"

namespace mw::client {
namespace {

constexpr std::int64_t NS_PER_S = 1000000000;
/// Maximum sleep before the process checks again whether the machine is alive.
constexpr std::int64_t LONGEST_SLEEP_NS = 100000000;

std::int64_t monotonic_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

/// Raises `count` to `number`; false when it is not lower.
bool raise(std::atomic<std::uint64_t> &count, std::uint64_t number) {
    std::uint64_t now = count.load(std::memory_order_relaxed);
    while (now < number) {
        if (count.compare_exchange_weak(now, number, std::memory_order_relaxed)) {
            return true;
        }
    }
    return false;
}

/// The oldest of the last `most` messages.
std::uint64_t oldest_of_last(std::uint64_t newest, std::uint64_t most) {
    const std::uint64_t count = std::min<std::uint64_t>(most, mailbox::MAX_MESSAGES);
    return newest > count ? newest - count + 1 : 1;
}

}  // namespace

Viewer::Viewer(mailbox::Segment &segment)
    : segment_(&segment), status_(std::make_unique<messages::PublishedStatus::Copy>()) {
    const std::uint64_t newest = segment.newest_message.load(std::memory_order_acquire);
    next_message_ = std::max(oldest_of_last(newest, mailbox::MAX_MESSAGES),
                             segment.read_message.load(std::memory_order_relaxed) + 1);
    heard_ = segment.bell.load(std::memory_order_acquire);
}

Viewer::Viewer(std::shared_ptr<MachineLink> link) : Viewer(link->segment()) {
    link_ = std::move(link);
}

Result<> Viewer::check_machine() const {
    if (link_ != nullptr) {
        return link_->check();
    }
    const bool is_alive = !memory_.has_value() || memory_->isOwnerAlive();
    return is_alive ? Result<>{} : fail("the machine is no longer running");
}

Result<Viewer> Viewer::attach(const std::string &instance) {
    auto memory = mailbox::Memory::attach(instance);
    if (!memory.has_value()) {
        return std::unexpected(memory.error());
    }
    Viewer viewer(memory->segment());
    viewer.memory_ = std::move(*memory);
    return viewer;
}

int Viewer::machine_pid() const {
    return memory_.has_value() ? memory_->owner_pid() : ::getpid();
}

std::int64_t Viewer::end_of(double timeout_s) {
    return monotonic_ns() + to_ns(timeout_s);
}

Result<> Viewer::sleep(std::uint32_t heard, std::int64_t end_ns) const {
    const std::int64_t left_ns = end_ns - monotonic_ns();
    if (left_ns <= 0) {
        return fail("the wait has timed out");
    }
    const bool rung = mailbox::Memory::wait(*segment_, heard, std::min(left_ns, LONGEST_SLEEP_NS));
    return rung ? Result<>{} : check_machine();
}

Result<> Viewer::wait_status(double timeout_s) {
    std::uint32_t now = heard_;
    const auto waited = wait_until(
        [&] {
            now = segment_->bell.load(std::memory_order_acquire);
            return now != heard_;
        },
        timeout_s);
    heard_ = now;
    return waited;
}

mailbox::Identity Viewer::identity() const {
    mailbox::Identity identity;
    return read_whole(segment_->identity, identity) ? identity : mailbox::Identity{};
}

Result<> Viewer::read_status() {
    if (segment_->cycles.load(std::memory_order_acquire) == 0) {
        return fail("the machine has not started yet");
    }
    return read_whole(segment_->status, *status_) ? Result<>{} : fail("task died while it wrote its status");
}

Result<std::optional<messages::ToolTable>> Viewer::read_tools() {
    const std::uint64_t version = segment_->tools_version.load(std::memory_order_acquire);
    if (version == tools_version_) {
        return std::nullopt;
    }
    auto bytes = std::make_unique<mailbox::Bytes>();
    if (!read_whole(segment_->tools, *bytes)) {
        return fail("task died while it wrote the tool table");
    }
    messages::ToolTable table;
    const std::size_t size = std::min<std::size_t>(bytes->size, bytes->bytes.size());
    const auto status = messages::decode({bytes->bytes.data(), size}, messages::object(table));
    if (!status.has_value()) {
        return std::unexpected(status.error());
    }
    tools_version_ = bytes->version;
    return table;
}

std::optional<Viewer::Message> Viewer::next_message(Reading reading) {
    if (link_ != nullptr) {
        link_->request_messages();
    }
    const std::uint64_t newest = segment_->newest_message.load(std::memory_order_acquire);
    if (next_message_ > newest) {
        return std::nullopt;
    }
    auto read = std::make_unique<mailbox::NumberedMessage>();
    const bool whole = read_whole(segment_->messages[next_message_ % mailbox::MAX_MESSAGES], *read);
    // the message was overwritten, or task died while it wrote the message
    if (!whole || read->number != next_message_) {
        const std::uint64_t now = segment_->newest_message.load(std::memory_order_acquire);
        const std::uint64_t oldest =
            now > mailbox::MAX_MESSAGES ? now - mailbox::MAX_MESSAGES + 2 : next_message_ + 1;
        const std::uint64_t first = std::max(oldest, next_message_ + 1);
        const std::uint64_t lost = first - next_message_;
        next_message_ = first;
        return Message{first - 1, monotonic_ns(), messages::MessageKind::OPERATOR_TEXT,
                       fmt::format("{} messages were lost: they came faster than this client read", lost)};
    }
    if (reading == Reading::COUNTS) {
        raise(segment_->read_message, next_message_);
    }
    ++next_message_;
    return Message{read->number, read->at_ns, read->kind, read->text.str()};
}

void Viewer::rewind_messages(std::uint64_t most) {
    next_message_ = oldest_of_last(segment_->newest_message.load(std::memory_order_acquire), most);
}

bool Viewer::claim_log(std::uint64_t number) const {
    return raise(segment_->logged_message, number);
}

}  // namespace mw::client
