// SPDX-License-Identifier: GPL-2.0-or-later
// A connection to an MQTT broker as the edge node uses it.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace mw::publish {

struct Publication {
    std::string topic;
    std::string payload;
    int qos = 0;
    bool isRetained = false;
};

// What a connection reports.
struct Connected {};
/// It is over, or could not be made.
struct Disconnected {
    std::string reason;
};
/// The broker has processed everything that was sent before the barrier.
struct BarrierPassed {
    int barrier = 0;
};
using LinkEvent = std::variant<Connected, Disconnected, Publication, BarrierPassed>;

/// One connection at a time. No call waits for the broker. One thread.
class BrokerLink {
  public:
    BrokerLink() = default;
    BrokerLink(const BrokerLink &) = delete;
    BrokerLink &operator=(const BrokerLink &) = delete;
    virtual ~BrokerLink() = default;

    /// Begins to connect, with a clean session, to a broker of the configured list.
    virtual void connect(std::size_t broker, const Publication &will) = 0;
    /// With QoS 1.
    virtual void subscribe(const std::string &topic) = 0;
    virtual void publish(const Publication &message) = 0;
    /// Number of the barrier.
    virtual int barrier() = 0;
    /// Sends DISCONNECT after everything else.
    virtual void disconnect() = 0;
    /// Closes the connection without a word: the broker sends the will.
    virtual void drop() = 0;
    /// The oldest report that was not read yet.
    virtual std::optional<LinkEvent> next_event() = 0;
};

}  // namespace mw::publish
