// SPDX-License-Identifier: GPL-2.0-or-later
// The interface of the edge node to an MQTT broker.
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

// Events of a connection.
struct Connected {};
/// The connection has ended or could not be established.
struct Disconnected {
    std::string reason;
};
/// The broker has processed everything sent before the barrier.
struct BarrierPassed {
    int barrier = 0;
};
using LinkEvent = std::variant<Connected, Disconnected, Publication, BarrierPassed>;

/// One connection at a time. No call waits for the broker. All calls come from one thread.
class BrokerLink {
  public:
    BrokerLink() = default;
    BrokerLink(const BrokerLink &) = delete;
    BrokerLink &operator=(const BrokerLink &) = delete;
    virtual ~BrokerLink() = default;

    /// Begins to connect to a broker of the configured list, with a clean session. A will without a topic is
    /// none.
    virtual void connect(std::size_t broker, const Publication &will) = 0;
    /// Subscribes with QoS 1.
    virtual void subscribe(const std::string &topic) = 0;
    virtual void publish(const Publication &message) = 0;
    /// Sends a barrier and returns its number.
    virtual int barrier() = 0;
    /// Sends DISCONNECT after all other packets.
    virtual void disconnect() = 0;
    /// Closes the connection without DISCONNECT, so that the broker sends the will.
    virtual void drop() = 0;
    /// The oldest event that was not read yet.
    virtual std::optional<LinkEvent> next_event() = 0;
};

}  // namespace mw::publish
