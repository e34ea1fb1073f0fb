// SPDX-License-Identifier: GPL-2.0-or-later
// Connections to MQTT brokers with libmosquitto: MQTT 3.1.1, with TLS if configured.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <vector>

#include "base/result.hh"
#include "clients/publish/sparkplug/broker_link.hh"

struct mosquitto;

namespace mw::publish {

struct BrokerAddress {
    std::string host;
    int port = 1883;
};

struct LinkSettings {
    std::vector<BrokerAddress> brokers;
    std::string client_id;
    int keepalive_s = 30;
    std::string user, password;  ///< empty user: anonymous
    bool isTls = false;
    std::string authorities;          ///< file of certificates; empty: those of the system
    std::string certificate, key;     ///< files of the client's certificate; empty: none
    std::string not_delivered_topic;  ///< a topic that is never subscribed; barriers unsubscribe from it
};

/// One thread, which must call wait() repeatedly.
class MosquittoLink final : public BrokerLink {
  public:
    explicit MosquittoLink(LinkSettings settings);
    ~MosquittoLink() override;

    /// Reads and writes available data; sleeps at most for `time`.
    void wait(std::chrono::milliseconds time);

    void connect(std::size_t broker, const Publication &will) override;
    void subscribe(const std::string &topic) override;
    void publish(const Publication &message) override;
    int barrier() override;
    void disconnect() override;
    void drop() override;
    std::optional<LinkEvent> next_event() override;

  private:
    Result<> begin(std::size_t broker, const Publication &will);
    void end();
    void lost(const std::string &why);

    LinkSettings settings_;
    mosquitto *client_ = nullptr;
    std::deque<LinkEvent> events_;
};

}  // namespace mw::publish
