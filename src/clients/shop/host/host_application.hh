// SPDX-License-Identifier: GPL-2.0-or-later
// A host application of Sparkplug B 3.0: follows births, data and deaths of nodes, and converts them to
// batches for a store. The only command that it sends is a request for a birth. It uses neither sockets nor
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
    std::string name;                 ///< name of the host application, as in PRIMARY_HOST of publishers
    std::vector<std::string> groups;  ///< groups that this host collects; empty: all
    double rebirth_s = 5;             ///< interval between two requests to one node
    /// Time from the birth of a node to those of its devices; earlier devices that are not born in this time
    /// have ended.
    double devices_s = 5;
    double receipt_s = 0.5;  ///< interval between two receipts to one node
    /// Time from the connection to the census: longer than the maximum pause of a publisher between two
    /// attempts.
    double census_s = 60;
    /// Maximum in one batch: a database that stores it within its time limit makes progress, however many
    /// readings wait.
    std::size_t batch_readings = 20'000;
};

/// A node whose messages have positions repeats messages without a receipt, and a receipt is sent only for
/// stored messages. So a host that drops everything with forget() loses nothing. From such a node only the
/// next message in order is accepted: after a missing message the aliases of the last birth may be wrong, and
/// the other messages are repeated after the requested birth. From a node without positions all messages are
/// accepted. All calls come from one thread.
class HostApplication {
  public:
    /// Time of day, and a monotonic time.
    struct Moment {
        TimeMs utc_ms = 0;
        double at_s = 0;
    };
    using Report = std::function<void(const std::string &)>;

    HostApplication(HostSettings settings, publish::BrokerLink &link, Report report);

    /// The message that the broker sends when this host is lost. It has the same time as the next
    /// connected().
    publish::Publication will(const Moment &now);
    void connected();
    /// Called before a connection ends in an orderly way.
    void say_offline();
    /// Called when the connection or the store is lost: births are requested again from nodes.
    void forget();

    void take(const publish::Publication &message, const Moment &now);
    /// Sends due messages.
    void step(const Moment &now);

    std::size_t waiting() const { return batch_.readings.size(); }
    bool hasBatch() const { return !batch_.isEmpty() || !unstored_.empty(); }
    /// The oldest readings that are not stored; without receipts if there are more.
    Batch take_batch();
    /// Called when a batch is stored.
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
    double receipts_s_ = -1e9;  ///< time of the next pass over receipts_
    std::optional<double> census_s_;
    bool isCounted_ = false;  ///< the census of this connection is done
    TimeMs state_at_ = 0;
    bool isOnline_ = false;

    std::map<NodeName, Node> nodes_;
    std::map<std::pair<MachineName, std::string>, SeriesId> series_;
    Batch batch_;
    std::map<NodeName, double> awaited_;    ///< nodes with awaited devices, and the end of the wait
    std::set<NodeName> unstored_;           ///< nodes with messages since the last batch
    std::map<NodeName, Receipt> receipts_;  ///< due receipts
};

/// Converts a value to its Sparkplug type; signed numbers arrive as their bits.
Value typed(const Value &value, std::uint32_t type);

}  // namespace mw::shop
