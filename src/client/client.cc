// SPDX-License-Identifier: GPL-2.0-or-later
#include "client/client.hh"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "base/patient_read.hh"
#include "msgs/binary.hh"
#include "msgs/catalogue.hh"

namespace mw::client {
namespace {

constexpr std::int64_t NS_PER_S = 1000000000;
/// A sleeper looks after so long whether the machine still lives.
constexpr std::int64_t LONGEST_SLEEP_NS = 100000000;

/// How long task may lie interrupted within a write before it counts as dead: as long as its watchdog.
constexpr std::chrono::milliseconds WRITER_PATIENCE{500};

std::int64_t monotonic_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * NS_PER_S + now.tv_nsec;
}

}  // namespace

Client::Client(mailbox::Segment &segment, int slot, mailbox::ClientId id)
    : segment_(&segment), slot_(slot), id_(id), status_(std::make_unique<msgs::PublishedStatus::Copy>()) {
    const std::uint64_t newest = segment.newest_message.load(std::memory_order_acquire);
    const std::uint64_t oldest = newest > mailbox::MAX_MESSAGES ? newest - mailbox::MAX_MESSAGES + 1 : 1;
    next_message_ = std::max(oldest, segment.read_message.load(std::memory_order_relaxed) + 1);
    heard_ = segment.bell.load(std::memory_order_acquire);
}

Client::Client(Client &&other) noexcept
    : memory_(std::move(other.memory_)), segment_(std::exchange(other.segment_, nullptr)), slot_(other.slot_),
      id_(other.id_), next_message_(other.next_message_), tools_version_(other.tools_version_),
      heard_(other.heard_), status_(std::move(other.status_)), found_(std::move(other.found_)),
      posted_stops_(std::move(other.posted_stops_)), replaced_stops_(std::move(other.replaced_stops_)) {}

Client &Client::operator=(Client &&other) noexcept {
    if (this != &other) {
        leave();
        memory_ = std::move(other.memory_);
        segment_ = std::exchange(other.segment_, nullptr);
        slot_ = other.slot_;
        id_ = other.id_;
        next_message_ = other.next_message_;
        tools_version_ = other.tools_version_;
        heard_ = other.heard_;
        status_ = std::move(other.status_);
        found_ = std::move(other.found_);
        posted_stops_ = std::move(other.posted_stops_);
        replaced_stops_ = std::move(other.replaced_stops_);
    }
    return *this;
}

Client::~Client() {
    leave();
}

void Client::leave() noexcept {
    if (segment_ != nullptr) {
        // Release: task sees everything that was posted before.
        slot().isLeaving.store(1, std::memory_order_release);
        segment_ = nullptr;
    }
}

Result<Client> Client::join(mailbox::Segment &segment, Role role) {
    const std::uint64_t me = mailbox::owner_word();
    // Before the place: task looks at no more places than numbers were given out.
    const mailbox::ClientId id = segment.client_ids.fetch_add(1, std::memory_order_acq_rel) + 1;
    for (int i = 0; i < mailbox::MAX_CLIENTS; ++i) {
        mailbox::Slot &slot = segment.slots[static_cast<std::size_t>(i)];
        std::uint64_t expected = 0;
        // Acquire: pairs with task's release when it freed the place.
        if (!slot.owner.compare_exchange_strong(expected, me, std::memory_order_acq_rel)) {
            continue;
        }
        slot.role.store(static_cast<std::uint8_t>(role), std::memory_order_relaxed);
        slot.client.store(id, std::memory_order_release);
        return Client(segment, i, id);
    }
    return fail(
        fmt::format("the machine has {} clients, which is as many as it can have", mailbox::MAX_CLIENTS));
}

Result<Client> Client::connect(const std::string &instance, Role role) {
    auto memory = mailbox::Memory::attach(instance);
    if (!memory.has_value()) {
        return std::unexpected(memory.error());
    }
    auto client = join(memory->segment(), role);
    if (client.has_value()) {
        client->memory_ = std::move(*memory);
    }
    return client;
}

Result<Serial> Client::post(const msgs::Command &command) {
    const auto allowed = msgs::check(command);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const std::string bytes = msgs::encode(command);
    auto posted = std::make_unique<mailbox::Posted>();
    if (bytes.size() > posted->bytes.size()) {
        return fail(fmt::format("a command of {} bytes is too large", bytes.size()));
    }
    if (slot().posted.size() >= mailbox::MAX_POSTED) {
        const std::optional<int> place = mailbox::stop_place(command);
        if (place.has_value()) {
            return post_stop(*place);
        }
        return fail(
            fmt::format("task has not taken the last {} commands of this client", mailbox::MAX_POSTED));
    }
    posted->serial = segment_->serials.fetch_add(1, std::memory_order_relaxed) + 1;
    posted->size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(posted->bytes.data(), bytes.data(), bytes.size());
    slot().posted.push(*posted);
    return posted->serial;
}

Serial Client::post_stop(int place) {
    const Serial serial = segment_->serials.fetch_add(1, std::memory_order_relaxed) + 1;
    // Release: task, which sees the stop, sees all that was posted before it.
    const Serial before =
        slot().stops[static_cast<std::size_t>(place)].exchange(serial, std::memory_order_acq_rel);
    // Release: task, which sees the number, sees the stop in its place.
    slot().newest_stop.store(serial, std::memory_order_release);
    posted_stops_.push_back({serial, place});
    if (before != 0) {
        replaced_stops_.emplace_back(before, serial);
    }
    if (replaced_stops_.size() > mailbox::MAX_OUTCOMES) {
        replaced_stops_.pop_front();
    }
    return serial;
}

bool Client::isStopWaiting(Serial serial) {
    std::erase_if(posted_stops_, [this](const PostedStop &stop) {
        // Acquire: pairs with task's clearing of it after it wrote the outcome.
        return slot().stops[static_cast<std::size_t>(stop.place)].load(std::memory_order_acquire) !=
               stop.serial;
    });
    return std::any_of(posted_stops_.begin(), posted_stops_.end(),
                       [serial](const PostedStop &stop) { return stop.serial == serial; });
}

template <class Lock, class Value>
bool Client::read_whole(const Lock &lock, Value &value) const {
    return read_patiently(lock, value, WRITER_PATIENCE, [this] { return isMachineAlive(); });
}

Outcome Client::outcome(Serial serial) {
    for (const auto &[before, later] : replaced_stops_) {  // in their order: a later one may be replaced too
        serial = before == serial ? later : serial;
    }
    if (isStopWaiting(serial)) {
        return {};
    }
    // Acquire: pairs with task's release after it wrote the outcome.
    if (slot().taken.load(std::memory_order_acquire) < serial) {
        return {};
    }
    // Before the outcomes: what is told later is looked at by the next call.
    const std::uint64_t told = slot().told.load(std::memory_order_acquire);
    if (found_.serial == serial && found_.told == told) {
        return found_.outcome;
    }
    const auto &outcomes = slot().outcomes;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const std::size_t place = (found_.place + i) % outcomes.size();  // mostly asked again
        mailbox::Outcome outcome;
        if (read_whole(outcomes[place], outcome) && outcome.serial == serial) {
            found_ = {serial, told, place, {outcome.progress, outcome.reason.str()}};
            return found_.outcome;
        }
    }
    return {msgs::Progress::REFUSED,
            fmt::format(
                "command {} is no longer remembered: this client has given {} later ones, or task has died",
                serial, mailbox::MAX_OUTCOMES)};
}

Result<> Client::sleep(std::uint32_t heard, std::int64_t end_ns) {
    const std::int64_t left_ns = end_ns - monotonic_ns();
    if (left_ns <= 0) {
        return fail("the time to wait is over");
    }
    const bool isRung = mailbox::Memory::wait(*segment_, heard, std::min(left_ns, LONGEST_SLEEP_NS));
    if (!isRung && !isMachineAlive()) {
        return fail("the machine is no longer running");
    }
    return {};
}

Result<Outcome> Client::wait(Serial serial, double timeout_s) {
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(timeout_s * 1e9);
    while (true) {
        const std::uint32_t heard = segment_->bell.load(std::memory_order_acquire);
        Outcome now = outcome(serial);
        if (now.progress != msgs::Progress::STARTED) {
            return now;
        }
        const auto status = sleep(heard, end_ns);
        if (!status.has_value()) {
            return std::unexpected(status.error());
        }
    }
}

Result<> Client::wait_status(double timeout_s) {
    const std::int64_t end_ns = monotonic_ns() + static_cast<std::int64_t>(timeout_s * 1e9);
    while (true) {
        const std::uint32_t now = segment_->bell.load(std::memory_order_acquire);
        if (now != heard_) {
            heard_ = now;
            return {};
        }
        const auto status = sleep(now, end_ns);
        if (!status.has_value()) {
            return status;
        }
    }
}

mailbox::Identity Client::identity() const {
    mailbox::Identity identity;
    return read_whole(segment_->identity, identity) ? identity : mailbox::Identity{};
}

Result<> Client::read_status() {
    if (segment_->cycles.load(std::memory_order_acquire) == 0) {
        return fail("the machine has not begun yet");
    }
    return read_whole(segment_->status, *status_) ? Result<>{} : fail("task died while it wrote its status");
}

Result<std::optional<msgs::ToolTable>> Client::read_tools() {
    const std::uint64_t version = segment_->tools_version.load(std::memory_order_acquire);
    if (version == tools_version_) {
        return std::nullopt;
    }
    auto bytes = std::make_unique<mailbox::Bytes>();
    if (!read_whole(segment_->tools, *bytes)) {
        return fail("task died while it wrote the tool table");
    }
    msgs::ToolTable table;
    const std::size_t size = std::min<std::size_t>(bytes->size, bytes->bytes.size());
    const auto status = msgs::decode({bytes->bytes.data(), size}, msgs::object(table));
    if (!status.has_value()) {
        return std::unexpected(status.error());
    }
    tools_version_ = bytes->version;
    return table;
}

std::optional<Client::Message> Client::next_message() {
    const std::uint64_t newest = segment_->newest_message.load(std::memory_order_acquire);
    if (next_message_ > newest) {
        return std::nullopt;
    }
    auto read = std::make_unique<mailbox::NumberedMessage>();
    const bool isWhole = read_whole(segment_->messages[next_message_ % mailbox::MAX_MESSAGES], *read);
    if (!isWhole || read->number != next_message_) {  // overwritten meanwhile, or task died within it
        const std::uint64_t now = segment_->newest_message.load(std::memory_order_acquire);
        const std::uint64_t oldest =
            now > mailbox::MAX_MESSAGES ? now - mailbox::MAX_MESSAGES + 2 : next_message_ + 1;
        const std::uint64_t first = std::max(oldest, next_message_ + 1);
        const std::uint64_t lost = first - next_message_;
        next_message_ = first;
        return Message{first - 1, msgs::MessageKind::OPERATOR_TEXT,
                       fmt::format("{} messages were lost: they came faster than this client read", lost)};
    }
    std::uint64_t told = segment_->read_message.load(std::memory_order_relaxed);
    while (told < next_message_ &&
           !segment_->read_message.compare_exchange_weak(told, next_message_, std::memory_order_relaxed)) {
    }
    ++next_message_;
    return Message{read->number, read->kind, read->text.str()};
}

}  // namespace mw::client
