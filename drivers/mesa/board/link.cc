// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/board/link.hh"

#include <algorithm>

namespace mw::mesa::board {

namespace {

/// The replies of the second host are not sent.
constexpr int SECOND_HOST = -1;

void insert_sorted(std::vector<Delivery> &queue, std::vector<Delivery> added) {
    for (Delivery &one : added) {
        const auto after = std::ranges::upper_bound(queue, one.time_ns, {}, &Delivery::time_ns);
        queue.insert(after, std::move(one));
    }
}

}  // namespace

Link::Link(Board &board, FaultPlan plan)
    : board_(board), plan_(std::move(plan)), to_board_(plan_.to_board, plan_.seed),
      to_host_(plan_.to_host, plan_.seed + 1) {}

bool Link::isDown(std::int64_t time_ns) const {
    return time_ns < down_until_ns_;
}

void Link::send(std::vector<std::byte> bytes, std::int64_t now_ns, int host) {
    run_until(now_ns);
    ++counts_.sent;
    if (!isDown(now_ns)) {
        insert_sorted(arriving_, to_board_.pass(std::move(bytes), now_ns, host));
    }
    run_until(now_ns);
}

std::optional<std::int64_t> Link::next_ns() const {
    std::optional<std::int64_t> next;
    const auto consider = [&](std::int64_t time_ns) { next = std::min(next.value_or(time_ns), time_ns); };
    if (!arriving_.empty()) {
        consider(arriving_.front().time_ns);
    }
    if (!replies_.empty()) {
        consider(replies_.front().time_ns);
    }
    if (next_event_ < plan_.events.size()) {
        consider(plan_.events[next_event_].at_ns);
    }
    if (second_next_ns_ < second_until_ns_) {
        consider(second_next_ns_);
    }
    return next;
}

void Link::run_until(std::int64_t now_ns) {
    while (true) {
        const std::int64_t event_ns =
            next_event_ < plan_.events.size() ? plan_.events[next_event_].at_ns : INT64_MAX;
        const std::int64_t packet_ns = arriving_.empty() ? INT64_MAX : arriving_.front().time_ns;
        const std::int64_t second_ns = second_next_ns_ < second_until_ns_ ? second_next_ns_ : INT64_MAX;
        if (std::min({event_ns, packet_ns, second_ns}) > now_ns) {
            break;
        }
        if (event_ns <= packet_ns && event_ns <= second_ns) {
            perform(plan_.events[next_event_++]);
        } else if (packet_ns <= second_ns) {
            const Delivery packet = std::move(arriving_.front());
            arriving_.erase(arriving_.begin());
            execute(packet);
        } else {
            read_as_second_host(second_ns);
            second_next_ns_ += second_period_ns_;
        }
    }
    board_.advance(now_ns);
}

void Link::execute(const Delivery &packet) {
    ++counts_.executed;
    auto reply = board_.execute(packet.bytes, packet.time_ns);
    if (reply.has_value() && packet.host != SECOND_HOST && !isDown(reply->time_ns)) {
        ++counts_.replies;
        insert_sorted(replies_, to_host_.pass(std::move(reply->bytes), reply->time_ns, packet.host));
    }
}

void Link::disturb(const DirectionFaults &to_board, const DirectionFaults &to_host, std::uint64_t seed) {
    to_board_ = FaultyDirection(to_board, seed);
    to_host_ = FaultyDirection(to_host, seed + 1);
}

void Link::perform(const FaultEvent &event) {
    switch (event.type) {
    case FaultType::RESET: board_.restart(event.at_ns, 0); break;
    case FaultType::POWER_OFF: board_.restart(event.at_ns, event.duration_ns); break;
    case FaultType::WATCHDOG:
        board_.advance(event.at_ns);
        board_.firmware().bite();
        break;
    case FaultType::LINK_DOWN: {
        const std::int64_t end_ns = event.at_ns + event.duration_ns;
        down_until_ns_ = std::max(down_until_ns_, end_ns);
        std::erase_if(arriving_, [&](const Delivery &one) { return one.time_ns < end_ns; });
        std::erase_if(replies_, [&](const Delivery &one) {
            return one.time_ns >= event.at_ns && one.time_ns < end_ns;
        });
        break;
    }
    case FaultType::SECOND_HOST:
        second_next_ns_ = event.at_ns;
        second_until_ns_ = event.at_ns + event.duration_ns;
        second_period_ns_ = event.period_ns;
        break;
    }
}

void Link::read_as_second_host(std::int64_t now_ns) {
    lbp16::PacketWriter packet;
    packet.read({.incrementing = false, .address = COOKIE_ADDRESS});
    packet.read({.space = lbp16::Space::CONTROL, .unit = lbp16::Unit::BITS_16, .units = 13});
    execute({now_ns, {packet.bytes().begin(), packet.bytes().end()}, SECOND_HOST});
}

std::optional<Delivery> Link::receive(std::int64_t now_ns) {
    run_until(now_ns);
    if (replies_.empty() || replies_.front().time_ns > now_ns) {
        return {};
    }
    ++counts_.received;
    Delivery reply = std::move(replies_.front());
    replies_.erase(replies_.begin());
    return reply;
}

}  // namespace mw::mesa::board
