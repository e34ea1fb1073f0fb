// SPDX-License-Identifier: GPL-2.0-or-later
// A host application of Sparkplug B 3.0: follows births, data and deaths of nodes, and turns them into
// batches for a store. The only command that it sends is a request for a birth. Knows neither sockets nor
// clocks.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "clients/publish/sparkplug/broker_link.hh"
#include "clients/publish/sparkplug/payload.hh"
#include "clients/shop/host/known_node.hh"
#include "clients/shop/reading.hh"

namespace mw::shop {

struct HostSettings {
    std::string name;                 ///< of the host application, as PRIMARY_HOST of publishers
    std::vector<std::string> groups;  ///< that this host collects; empty: all
    double rebirth_s = 5;             ///< between two requests to one node
    /// From the birth of a node to those of its devices: what was there before and is not born then has
    /// ended.
    double devices_s = 5;
    double receipt_s = 0.5;  ///< between two receipts to one node
    /// From the connection to the census: longer than the longest pause of a publisher between two attempts.
    double census_s = 60;
    /// In one batch: a database that stores it within its time limit makes progress, no matter how many wait.
    std::size_t batch_readings = 20'000;
};

/// A node whose messages have positions repeats what has no receipt, and a receipt is sent only for what is
/// stored: a host that forgets everything with forget() loses nothing. Of such a node only the next message
/// is taken: after a missing one the aliases of the last birth may be wrong, and the others come again after
/// the birth that is requested. Of a node without positions everything is taken. One thread.
class HostApplication {
  public:
    /// Time of the day, and a time that never jumps.
    struct Moment {
        TimeMs utc_ms = 0;
        double at_s = 0;
    };
    using Report = std::function<void(const std::string &)>;

    HostApplication(HostSettings settings, publish::BrokerLink &link, Report report);

    /// What the broker sends when this host has gone: the same time as that of the next connected().
    publish::Publication will(const Moment &now);
    void connected();
    /// Before a connection ends in order.
    void say_offline();
    /// The connection, or the store, is lost: nodes are asked for births again.
    void forget();

    void take(const publish::Publication &message, const Moment &now);
    /// Sends what is due.
    void step(const Moment &now);

    std::size_t waiting() const { return batch_.readings.size(); }
    bool hasBatch() const { return !batch_.isEmpty() || !unstored_.empty(); }
    /// The oldest part of what is not stored, without receipts when there is more.
    Batch take_batch();
    /// A batch is in the store.
    void stored(const std::vector<NodeReceipt> &receipts);

  private:
    using Metric = KnownMetric;
    using Device = KnownDevice;
    using Node = KnownNode;
    /// The parts of a topic.
    struct Topic {
        NodeName node;
        std::string type, device;
    };
    static std::optional<Topic> split(std::string_view topic);

    void publish_state(bool isOnline);
    void take_birth_of_node(Node &node, const Topic &topic, const publish::Payload &payload);
    void take_death_of_node(Node &node, const Topic &topic, const publish::Payload &payload);
    static bool follow_sequence(Node &node, const publish::Payload &payload);
    void define(Device &device, const Topic &topic, const publish::Payload &payload);
    void add_readings(Node &node, const Topic &topic, const publish::Payload &payload);
    static const Metric *find(const Device &device, const publish::PayloadMetric &metric);
    void set_alive(Node &node, const MachineName &name, bool isAlive, TimeMs at);
    SeriesId series_of(const MachineName &machine, const publish::PayloadMetric &metric);
    void request_birth(Node &node, const NodeName &name);
    /// The time of the node's clock.
    TimeMs now_of(const Node &node) const;
    void take_census();
    void miss_devices();

    HostSettings settings_;
    publish::BrokerLink &link_;
    Report report_;
    std::string state_topic_;
    Moment now_;
    double receipts_s_ = -1e9;  ///< of the next pass over receipts_
    std::optional<double> census_s_;
    bool isCounted_ = false;  ///< the census of this connection is done
    TimeMs state_at_ = 0;
    bool isOnline_ = false;

    std::map<NodeName, Node> nodes_;
    std::map<std::pair<MachineName, std::string>, SeriesId> series_;
    Batch batch_;
    std::map<NodeName, double> awaited_;    ///< nodes with awaited devices, and until when
    std::set<NodeName> unstored_;           ///< nodes with messages since the last batch
    std::map<NodeName, Receipt> receipts_;  ///< that are due
};

/// A value as its type of Sparkplug is; signed numbers come as their bits.
Value typed(const Value &value, std::uint32_t type);

}  // namespace mw::shop
