// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/mailbox/command_server.hh"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <utility>

#include "messages/declarations/binary.hh"
#include "messages/declarations/catalogue.hh"
#include "messages/mailbox/memory.hh"
#include "messages/mailbox/places.hh"

namespace mw::mailbox {
namespace {

using messages::Progress;

/// Interval in cycles of the checks for dead owners: one slot in turn, and the slots of attended clients.
/// When no slot is free, one slot is checked in each cycle.
constexpr std::uint64_t OWNER_CHECK_CYCLES = 4;

/// A byte that is not a valid authority is treated as the least authority.
Authority authority_of(const Slot &slot) {
    constexpr auto ALL = static_cast<std::uint8_t>(Authority::CONFIGURE);
    return slot.authority.load(std::memory_order_relaxed) == ALL ? Authority::CONFIGURE : Authority::OPERATE;
}

bool isOf(const Slot &slot, Role role) {
    return slot.role.load(std::memory_order_relaxed) == static_cast<std::uint8_t>(role);
}

template <class Text>
void assign(Text &text, std::string_view from) {
    if (!text.assign(from)) {
        constexpr std::string_view MORE = "...";
        const std::string_view kept = text.view().substr(0, Text::CAPACITY - MORE.size());
        Text whole;
        whole.assign(kept);
        text.assign(whole.str() + std::string(MORE));
    }
}

std::int64_t monotonic_ns() {
    return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

std::uint64_t random_run() {
    std::random_device random;
    return std::uint64_t{random()} << 32U | random() | 1U;
}

}  // namespace

CommandServer::CommandServer(Segment &segment, Rights rights, std::function<std::int64_t()> clock)
    : segment_(segment), rights_(rights), clock_(clock ? std::move(clock) : monotonic_ns) {
    segment_.run.store(random_run(), std::memory_order_release);
}

std::vector<CommandServer::Delivery> CommandServer::take(std::int64_t now_ns) {
    now_ns_ = now_ns;
    ++cycles_;
    if (right_.step(now_ns)) {
        post(messages::MessageKind::OPERATOR_TEXT,
             "the right to operate alone has expired: all clients can operate again");
    }
    std::vector<Delivery> taken;
    // A client gets its number, then the first free slot after the reserved ones. So no more of these slots
    // are in use than numbers were assigned.
    const auto used = std::min<ClientId>(MAX_CLIENTS, segment_.client_ids.load(std::memory_order_acquire) +
                                                          RESERVED_CLIENTS);
    int owned = 0;
    for (int i = 0; i < static_cast<int>(used); ++i) {
        // Acquire: pairs with the client's store of its owner word.
        if (segment_.slots[static_cast<std::size_t>(i)].owner.load(std::memory_order_acquire) != 0) {
            take_slot(i, taken);
            owned += i >= RESERVED_CLIENTS ? 1 : 0;
        }
    }
    full_ = owned == MAX_CLIENTS - RESERVED_CLIENTS;
    std::sort(taken.begin(), taken.end(),
              [](const Delivery &a, const Delivery &b) { return a.serial < b.serial; });
    std::vector<Delivery> allowed;
    for (Delivery &delivery : taken) {
        // A panel is wired to the machine, so another client's right to operate never affects it.
        const auto right = delivery.isPanel ? Result<>{} : right_.check(delivery.client, delivery.command);
        if (!right.has_value()) {
            tell(delivery.serial, Progress::REFUSED, right.error().str());
        } else if (rights_ == Rights::DELIVERED || !operate(delivery)) {
            allowed.push_back(std::move(delivery));
        }
    }
    return allowed;
}

void CommandServer::take_slot(int index, std::vector<Delivery> &out) {
    Slot &slot = segment_.slots[static_cast<std::size_t>(index)];
    // Read before the commands: a client that leaves has posted all its commands.
    const bool isLeaving = slot.isLeaving.load(std::memory_order_acquire) != 0;
    // Reads the stops before the queue. Commands that were posted before a stop are then in the queue and are
    // executed first.
    const std::vector<WaitingStop> stops = waiting_stops(index);
    auto stop = stops.begin();
    const auto accept_stops_before = [&](Serial serial) {
        for (; stop != stops.end() && stop->serial < serial; ++stop) {
            accept(index, stop->serial, stop_at(stop->place), out);
            Serial accepted = stop->serial;
            // Release: a client that sees the stop as taken finds its outcome. A newer stop of the same type
            // remains.
            slot.stops[static_cast<std::size_t>(stop->place)].compare_exchange_strong(
                accepted, 0, std::memory_order_acq_rel);
        }
    };
    for (std::uint32_t n = 0; n < MAX_POSTED && slot.posted.pop(posted_); ++n) {
        accept_stops_before(posted_.serial);
        const std::size_t size = std::min<std::size_t>(posted_.size, posted_.bytes.size());
        accept(index, posted_.serial, messages::decode_command({posted_.bytes.data(), size}), out);
    }
    accept_stops_before(std::numeric_limits<Serial>::max());
    const std::uint64_t check_cycles = full_ ? 1 : OWNER_CHECK_CYCLES;
    const bool is_turn = cycles_ % check_cycles == 0 &&
                         (cycles_ / check_cycles) % MAX_CLIENTS == static_cast<std::uint64_t>(index);
    const bool watched = cycles_ % OWNER_CHECK_CYCLES == 0 && isOf(slot, Role::ATTENDED);
    if (isLeaving || is_turn || watched) {
        check_owner(index, out);
    }
}

std::vector<CommandServer::WaitingStop> CommandServer::waiting_stops(int index) {
    const Slot &slot = segment_.slots[static_cast<std::size_t>(index)];
    std::vector<WaitingStop> waiting;
    // Acquire: a reader that sees the number finds the stop in its slot.
    const Serial newest = slot.newest_stop.load(std::memory_order_acquire);
    if (newest == newest_stops_[static_cast<std::size_t>(index)]) {
        return waiting;
    }
    newest_stops_[static_cast<std::size_t>(index)] = newest;
    for (int place = 0; place < STOP_PLACES; ++place) {
        // Acquire: pairs with the client's store of the stop.
        const Serial serial = slot.stops[static_cast<std::size_t>(place)].load(std::memory_order_acquire);
        if (serial != 0) {
            waiting.push_back({serial, place});
        }
    }
    std::sort(waiting.begin(), waiting.end(),
              [](const WaitingStop &a, const WaitingStop &b) { return a.serial < b.serial; });
    return waiting;
}

void CommandServer::stop_unattended(int index, std::vector<Delivery> &out) {
    const bool under_way = std::any_of(going_.begin(), going_.end(),
                                       [index](const auto &going) { return going.second.slot == index; });
    if (!under_way) {
        return;
    }
    const ClientId client = segment_.slots[static_cast<std::size_t>(index)].client.load();
    post(messages::MessageKind::OPERATOR_ERROR,
         "client " + std::to_string(client) +
             ", which monitored its commands, has disconnected: its work was aborted");
    const Serial serial = segment_.serials.fetch_add(1, std::memory_order_relaxed) + 1;
    out.push_back({serial, client, messages::AbortAll{}, true, Authority::OPERATE, 0});
}

void CommandServer::check_owner(int index, std::vector<Delivery> &out) {
    Slot &slot = segment_.slots[static_cast<std::size_t>(index)];
    const bool isLeaving = slot.isLeaving.load(std::memory_order_acquire) != 0;
    if (!isLeaving && isAlive(slot.owner.load(std::memory_order_relaxed))) {
        return;
    }
    const ClientId client = slot.client.load(std::memory_order_relaxed);
    const bool hadRight = client != 0 && right_.status(now_ns_).holder == client;
    right_.forget(client);
    if (hadRight) {
        post(messages::MessageKind::OPERATOR_TEXT,
             "client " + std::to_string(client) +
                 ", which operated alone, has disconnected: all clients can operate again");
    }
    if (isOf(slot, Role::ATTENDED)) {
        stop_unattended(index, out);
    }
    // Commands of clients that have left continue, because a client need not outlive its program. Their
    // outcomes are dropped.
    std::erase_if(going_, [index](const auto &going) { return going.second.slot == index; });
    serials_[static_cast<std::size_t>(index)].fill(0);
    for (auto &outcome : slot.outcomes) {
        outcome.write({});
    }
    for (std::uint32_t n = 0; n < MAX_POSTED && slot.posted.pop(posted_); ++n) {
        // Drops commands that the client posted between the last read and its death.
    }
    for (auto &stop : slot.stops) {
        stop.store(0, std::memory_order_relaxed);
    }
    slot.newest_stop.store(0, std::memory_order_relaxed);
    newest_stops_[static_cast<std::size_t>(index)] = 0;
    slot.client.store(0, std::memory_order_relaxed);
    slot.taken.store(0, std::memory_order_relaxed);
    slot.isLeaving.store(0, std::memory_order_relaxed);
    slot.authority.store(0, std::memory_order_relaxed);
    // Release: the next owner finds an empty slot.
    slot.owner.store(0, std::memory_order_release);
}

int CommandServer::free_outcome(int slot) const {
    const auto &serials = serials_[static_cast<std::size_t>(slot)];
    int oldest = -1;
    for (int i = 0; i < MAX_OUTCOMES; ++i) {
        const Serial serial = serials[static_cast<std::size_t>(i)];
        const bool under_way = serial != 0 && going_.contains(serial);
        if (!under_way && (oldest < 0 || serial < serials[static_cast<std::size_t>(oldest)])) {
            oldest = i;
        }
    }
    return oldest;
}

void CommandServer::accept(int index, Serial serial, Result<messages::Command> command,
                           std::vector<Delivery> &out) {
    Slot &slot = segment_.slots[static_cast<std::size_t>(index)];
    const bool is_new =
        serial != 0 && serial <= segment_.serials.load(std::memory_order_relaxed) && !going_.contains(serial);
    const int place = free_outcome(index);
    const Serial taken = std::max(serial, slot.taken.load(std::memory_order_relaxed));
    const bool isPanel = isOf(slot, Role::PANEL);
    const ClientId client = slot.client.load(std::memory_order_relaxed);
    const Authority authority = authority_of(slot);
    const std::uint64_t owner = slot.owner.load(std::memory_order_relaxed);
    if (is_new && place < 0 && command.has_value() && isStop(*command)) {
        // A stop is never dropped: it is executed even if its outcome cannot be reported.
        note(serial, Progress::STARTED);
        slot.taken.store(taken, std::memory_order_release);
        out.push_back({serial, client, std::move(*command), isPanel, authority, owner});
        return;
    }
    if (!is_new || place < 0) {
        // Either the number was not assigned by the mailbox, or MAX_OUTCOMES commands are under way: no
        // outcome can be reported.
        post(messages::MessageKind::OPERATOR_ERROR,
             "client " + std::to_string(client) +
                 (is_new ? " has too many pending commands: a command was dropped"
                         : " sent a command with a wrong number"));
        if (is_new) {
            note(serial, Progress::REFUSED);
        }
        slot.taken.store(taken, std::memory_order_release);
        return;
    }
    going_[serial] = {index, place, {serial, Progress::STARTED, {}}};
    serials_[static_cast<std::size_t>(index)][static_cast<std::size_t>(place)] = serial;
    write(going_[serial]);
    note(serial, Progress::STARTED);
    // Release: a client that sees the command as taken finds its outcome.
    slot.taken.store(taken, std::memory_order_release);
    if (!command.has_value()) {
        tell(serial, Progress::REFUSED, command.error().str());
        return;
    }
    out.push_back({serial, client, std::move(*command), isPanel, authority, owner});
}

bool CommandServer::isConnected(ClientId client) const {
    return client != 0 &&
           std::any_of(segment_.slots.begin(), segment_.slots.end(), [client](const Slot &slot) {
               return slot.owner.load(std::memory_order_acquire) != 0 && slot.client.load() == client;
           });
}

bool CommandServer::operate(const Delivery &delivery) {
    Result<> status;
    if (const auto *claim = std::get_if<messages::ClaimOperation>(&delivery.command)) {
        status = right_.claim(delivery.client, claim->lease_s, now_ns_);
    } else if (const auto *hand_over = std::get_if<messages::HandOverOperation>(&delivery.command)) {
        status = isConnected(hand_over->client)
                     ? right_.hand_over(delivery.client, hand_over->client, now_ns_)
                     : fail("there is no client " + std::to_string(hand_over->client));
    } else if (std::holds_alternative<messages::ReleaseOperation>(delivery.command)) {
        status = right_.release(delivery.client);
    } else {
        return false;
    }
    tell(delivery.serial, status.has_value() ? Progress::DONE : Progress::REFUSED,
         status.has_value() ? std::string() : status.error().str());
    return true;
}

void CommandServer::write(const Place &place) {
    Slot &slot = segment_.slots[static_cast<std::size_t>(place.slot)];
    slot.outcomes[static_cast<std::size_t>(place.outcome)].write(place.written);
    // Release: a reader that sees the count finds the outcome.
    slot.told.fetch_add(1, std::memory_order_release);
}

void CommandServer::note(Serial serial, Progress progress) {
    const bool newer = serial > last_command_;
    const bool is_going = serial == last_command_ && last_progress_ == Progress::STARTED;
    if (newer || is_going) {
        last_command_ = serial;
        last_progress_ = progress;
    }
}

void CommandServer::tell(Serial serial, Progress progress, const std::string &reason) {
    note(serial, progress);
    const auto found = going_.find(serial);
    if (found == going_.end()) {
        return;  // its client has ended
    }
    found->second.written.progress = progress;
    assign(found->second.written.reason, reason);
    write(found->second);
    if (progress != Progress::STARTED) {
        going_.erase(found);
    }
}

void CommandServer::post(messages::MessageKind kind, std::string_view text) {
    auto message = std::make_unique<NumberedMessage>();
    message->number = newest_message() + 1;
    message->at_ns = clock_();
    message->kind = kind;
    assign(message->text, text);
    segment_.messages[message->number % MAX_MESSAGES].write(*message);
    // Release: a reader that sees the number finds the message.
    segment_.newest_message.store(message->number, std::memory_order_release);
}

void CommandServer::publish(messages::MachineStatus &status, PartMask motion_parts) {
    namespace part = messages::status_part;
    constexpr PartMask ALWAYS = part_range(part::TASK, 1);
    constexpr PartMask SELDOM = part_range(part::PROGRAM, 1) | part_range(part::CODES, 1) |
                                part_range(part::OFFSETS, 1) | part_range(part::DEVICES, 1) |
                                part_range(part::APPROACH, 2);
    status.operation = right_.status(now_ns_);
    status.last_message = newest_message();
    status.last_command = last_command_;
    status.last_progress = last_progress_;
    const PartMask others = ALWAYS | segment_.status.changed(status, SELDOM);
    segment_.status.write(status, (motion_parts & ~SELDOM) | others);
    segment_.cycles.store(cycles_, std::memory_order_release);
    Memory::ring(segment_);
}

bool CommandServer::publish_tools(const messages::ToolTable &table) {
    std::string encoded;
    messages::encode(messages::object(table), encoded);
    if (encoded.size() > MAX_TOOL_BYTES) {
        return false;
    }
    auto bytes = std::make_unique<Bytes>();
    bytes->version = table.version;
    bytes->size = encoded.size();
    std::memcpy(bytes->bytes.data(), encoded.data(), encoded.size());
    segment_.tools.write(*bytes);
    segment_.tools_version.store(table.version, std::memory_order_release);
    return true;
}

}  // namespace mw::mailbox
