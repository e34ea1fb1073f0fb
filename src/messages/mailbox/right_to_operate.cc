// SPDX-License-Identifier: GPL-2.0-or-later
#include "messages/mailbox/right_to_operate.hh"

#include <algorithm>

#include <fmt/format.h>

#include "base/duration.hh"
#include "messages/mailbox/stops.hh"

namespace mw::mailbox {
namespace {

using namespace messages;

constexpr double NS_PER_S = 1e9;

}  // namespace

void RightToOperate::give(ClientId client, std::int64_t now_ns) {
    handovers_ += client != holder_ ? 1 : 0;
    holder_ = client;
    end_ns_ = now_ns + lease_ns_;
}

Result<> RightToOperate::claim(ClientId client, double lease_s, std::int64_t now_ns) {
    if (holder_ != 0 && holder_ != client) {
        return fail(fmt::format("client {} operates the machine", holder_), {}, "it can transfer the right");
    }
    lease_ns_ = to_ns(lease_s);
    give(client, now_ns);
    return {};
}

Result<> RightToOperate::hand_over(ClientId from, ClientId to, std::int64_t now_ns) {
    if (holder_ != from) {
        return fail("only the client that operates the machine can transfer the right");
    }
    give(to, now_ns);
    return {};
}

Result<> RightToOperate::release(ClientId client) {
    if (holder_ != client) {
        return fail("this client does not have the right to operate alone");
    }
    forget(client);
    return {};
}

void RightToOperate::forget(ClientId client) {
    if (holder_ == client && client != 0) {
        holder_ = 0;
        ++handovers_;
    }
}

bool RightToOperate::step(std::int64_t now_ns) {
    const bool over = holder_ != 0 && now_ns >= end_ns_;
    if (over) {
        forget(holder_);
    }
    return over;
}

Result<> RightToOperate::check(ClientId client, const Command &command) const {
    if (holder_ == 0 || holder_ == client || isStop(command)) {
        return {};
    }
    return fail(fmt::format("client {} operates the machine alone", holder_), {},
                "stops are accepted from all clients");
}

OperationStatus RightToOperate::status(std::int64_t now_ns) const {
    const std::int64_t left_ns = holder_ == 0 ? 0 : std::max<std::int64_t>(0, end_ns_ - now_ns);
    return {holder_, static_cast<double>(left_ns) / NS_PER_S, handovers_};
}

}  // namespace mw::mailbox
