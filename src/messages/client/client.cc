// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/client/client.hh"

#include <algorithm>
#include <cstring>
#include <memory>

#include <fmt/format.h>

#include "messages/declarations/binary.hh"
#include "messages/declarations/catalogue.hh"

namespace mw::client {

Client::Client(Viewer viewer, int slot, mailbox::ClientId id)
    : viewer_(std::move(viewer)), slot_(slot), id_(id) {}

Client::Client(Client &&other) noexcept
    : viewer_(std::move(other.viewer_)), hasPlace_(std::exchange(other.hasPlace_, false)), slot_(other.slot_),
      id_(other.id_), found_(std::move(other.found_)), posted_stops_(std::move(other.posted_stops_)),
      replaced_stops_(std::move(other.replaced_stops_)) {}

Client &Client::operator=(Client &&other) noexcept {
    if (this != &other) {
        leave();
        viewer_ = std::move(other.viewer_);
        hasPlace_ = std::exchange(other.hasPlace_, false);
        slot_ = other.slot_;
        id_ = other.id_;
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
    if (hasPlace_) {
        // Release: task sees everything that this client posted before.
        slot().isLeaving.store(1, std::memory_order_release);
        hasPlace_ = false;
    }
}

Result<Client> Client::join(mailbox::Segment &segment, Role role, Places places) {
    return join(Viewer(segment), role, places);
}

Result<Client> Client::join(Viewer viewer, Role role, Places places) {
    mailbox::Segment &segment = viewer.segment();
    const std::uint64_t me = mailbox::owner_word();
    // Gets the number before the slot, because task reads no more slots than numbers were assigned.
    const mailbox::ClientId id = segment.client_ids.fetch_add(1, std::memory_order_acq_rel) + 1;
    const int first = places == Places::RESERVED ? 0 : mailbox::RESERVED_CLIENTS;
    for (int i = first; i < mailbox::MAX_CLIENTS; ++i) {
        mailbox::Slot &slot = segment.slots[static_cast<std::size_t>(i)];
        std::uint64_t expected = 0;
        // Acquire: pairs with task's release when it freed the slot.
        if (!slot.owner.compare_exchange_strong(expected, me, std::memory_order_acq_rel)) {
            continue;
        }
        slot.role.store(static_cast<std::uint8_t>(role), std::memory_order_relaxed);
        slot.authority.store(static_cast<std::uint8_t>(mailbox::Authority::CONFIGURE),
                             std::memory_order_relaxed);
        slot.client.store(id, std::memory_order_release);
        return Client(std::move(viewer), i, id);
    }
    return fail(fmt::format("the machine has {} clients, the maximum", mailbox::MAX_CLIENTS - first));
}

Result<Client> Client::connect(const std::string &instance, Role role, Places places) {
    auto viewer = Viewer::attach(instance);
    return viewer.has_value() ? join(std::move(*viewer), role, places) : std::unexpected(viewer.error());
}

void Client::limit_authority(mailbox::Authority most) {
    const auto value = static_cast<std::uint8_t>(most);
    if (value < slot().authority.load(std::memory_order_relaxed)) {
        // The next posted command releases it.
        slot().authority.store(value, std::memory_order_relaxed);
    }
}

Result<Serial> Client::post(const messages::Command &command) {
    const auto allowed = messages::check(command);
    if (!allowed.has_value()) {
        return std::unexpected(allowed.error());
    }
    const std::string bytes = messages::encode(command);
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
            fmt::format("task has not accepted the last {} commands of this client", mailbox::MAX_POSTED));
    }
    posted->serial = viewer_.segment().serials.fetch_add(1, std::memory_order_relaxed) + 1;
    posted->size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(posted->bytes.data(), bytes.data(), bytes.size());
    slot().posted.push(*posted);
    announce();
    return posted->serial;
}

void Client::announce() const {
    if (viewer_.link() != nullptr) {
        viewer_.link()->command_posted();
    }
}

Serial Client::post_stop(int place) {
    const Serial serial = viewer_.segment().serials.fetch_add(1, std::memory_order_relaxed) + 1;
    // Release: when task sees the stop, it sees everything posted before the stop.
    const Serial before =
        slot().stops[static_cast<std::size_t>(place)].exchange(serial, std::memory_order_acq_rel);
    // Release: when task sees the number, it sees the stop in its slot.
    slot().newest_stop.store(serial, std::memory_order_release);
    posted_stops_.push_back({serial, place});
    announce();
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
        // Acquire: pairs with task's clearing of the slot after it wrote the outcome.
        return slot().stops[static_cast<std::size_t>(stop.place)].load(std::memory_order_acquire) !=
               stop.serial;
    });
    return std::any_of(posted_stops_.begin(), posted_stops_.end(),
                       [serial](const PostedStop &stop) { return stop.serial == serial; });
}

Outcome Client::outcome(Serial serial) {
    // checked in order, because a later stop may be replaced, too
    for (const auto &[before, later] : replaced_stops_) {
        serial = before == serial ? later : serial;
    }
    if (!isTaken(serial)) {
        return {};
    }
    // Read before the outcomes, so that the next call reads outcomes reported later.
    const std::uint64_t told = slot().told.load(std::memory_order_acquire);
    if (found_.serial == serial && found_.told == told) {
        return found_.outcome;
    }
    const auto &outcomes = slot().outcomes;
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        // the same outcome is often requested again
        const std::size_t place = (found_.place + i) % outcomes.size();
        mailbox::Outcome outcome;
        if (viewer_.read_whole(outcomes[place], outcome) && outcome.serial == serial) {
            found_ = {serial, told, place, {outcome.progress, outcome.reason.str()}};
            return found_.outcome;
        }
    }
    return {messages::Progress::REFUSED, fmt::format("the result of command {} is no longer stored: this "
                                                     "client has sent {} later commands, or task has ended",
                                                     serial, mailbox::MAX_OUTCOMES)};
}

Result<Outcome> Client::wait(Serial serial, double timeout_s) {
    Outcome now;
    const auto waited = viewer_.wait_until(
        [&] {
            now = outcome(serial);
            return now.progress != messages::Progress::STARTED;
        },
        timeout_s);
    return waited.has_value() ? Result<Outcome>(now) : std::unexpected(waited.error());
}

Result<> Client::wait_taken(Serial serial, double timeout_s) {
    return viewer_.wait_until([&] { return isTaken(serial); }, timeout_s);
}

bool Client::isTaken(Serial serial) {
    // Acquire: pairs with task's release after it wrote the outcome.
    return !isStopWaiting(serial) && slot().taken.load(std::memory_order_acquire) >= serial;
}

}  // namespace mw::client
