// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/commander.hh"

#include <algorithm>

namespace mw::rsh {
namespace {

/// A jog ends this long after its last renewal.
constexpr int LEASE_MS = 500;
constexpr double RENEWAL_S = 0.1;

}  // namespace

Result<> Commander::connect() {
    if (client_.has_value()) {
        return {};
    }
    auto joined = joining_();
    if (!joined.has_value()) {
        return std::unexpected(joined.error());
    }
    client_.emplace(std::move(*joined));
    return {};
}

Result<client::Serial> Commander::post(const messages::Command &command) {
    auto connected = connect();
    if (!connected.has_value()) {
        return std::unexpected(connected.error());
    }
    auto serial = client_->post(command);
    if (serial.has_value()) {
        if (isFresh_) {
            last_.clear();
            isFresh_ = false;
        }
        last_.push_back(*serial);
    }
    return serial;
}

Result<client::Serial> Commander::jog(const JogTarget &target, double velocity) {
    auto serial = post(messages::JogContinuous{target.isJoint, target.index, velocity, LEASE_MS});
    if (serial.has_value()) {
        std::erase_if(jogs_, [&](const Jog &jog) { return jog.target == target; });
        jogs_.push_back({target, velocity, *serial});
    }
    return serial;
}

Result<client::Serial> Commander::stop_jog(const JogTarget &target) {
    std::erase_if(jogs_, [&](const Jog &jog) { return jog.target == target; });
    return post(messages::JogStop{target.isJoint, target.index});
}

void Commander::stop_jogs() {
    while (!jogs_.empty()) {
        // The stop cannot fail, because the mailbox always has space for stops.
        static_cast<void>(stop_jog(jogs_.back().target));
    }
}

void Commander::keep_jogging(double now_s) {
    for (Jog &jog : jogs_) {
        if (jog.renewed_s < 0) {
            jog.renewed_s = now_s;
        }
        if (now_s - jog.renewed_s < RENEWAL_S ||
            outcome(jog.serial).progress == messages::Progress::REFUSED) {
            continue;
        }
        // Not through post(), because nobody waits for this command.
        const auto serial = client_->post(
            messages::JogContinuous{jog.target.isJoint, jog.target.index, jog.velocity, LEASE_MS, true});
        jog.serial = serial.value_or(jog.serial);
        jog.renewed_s = now_s;
    }
    // A limit, an abort or another client has ended the jog.
    std::erase_if(jogs_, [this](const Jog &jog) {
        const auto progress = outcome(jog.serial).progress;
        return progress == messages::Progress::REFUSED || progress == messages::Progress::FAILED;
    });
}

}  // namespace mw::rsh
