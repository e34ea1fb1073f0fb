// SPDX-License-Identifier: GPL-2.0-or-later
// An edge node of Sparkplug B 3.0: births, data, deaths, rebirth, and the values that waited for a broker.
// The machine is its device. It uses neither sockets nor clocks.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "clients/publish/sparkplug/broker_link.hh"
#include "clients/publish/sparkplug/delivery.hh"
#include "clients/publish/sparkplug/live_data.hh"
#include "clients/publish/sparkplug/payload.hh"

namespace mw::publish {

struct NodeSettings {
    std::string group{}, node{}, device{};
    std::string primary_host{};  ///< empty: the node does not wait for a host
    std::size_t brokers = 1;     ///< number of brokers in the list
    std::string software{};      ///< name and version
    double first_retry_s = 1, longest_retry_s = 30;
    double answer_s = 10;  ///< timeout of a connection, and of a barrier
    Delivery::Settings delivery{};
    bool isTyped = false;    ///< data also contain the types of their values
    std::size_t batch = 50;  ///< number of history records in a message
};

/// The reason why a name cannot be part of a topic; empty if it can.
std::string check_topic_part(std::string_view name);

/// All calls come from one thread.
class EdgeNode {
  public:
    /// Time of day, and a monotonic time.
    struct Moment {
        TimeMs utc_ms = 0;
        double at_s = 0;
    };
    /// Stores the next bdSeq number before it is used.
    using KeepNumber = std::function<void(std::uint64_t next)>;
    using Report = std::function<void(const std::string &)>;

    EdgeNode(NodeSettings settings, LiveData &data, BrokerLink &link, std::uint64_t bdseq, KeepNumber keep,
             Report report);

    void step(const Moment &now);
    /// Publishes the death of the node and disconnects.
    void end(const Moment &now);
    bool isOnline() const { return phase_ == Phase::ONLINE; }

  private:
    enum class Phase : std::uint8_t { WAITING, CONNECTING, HOST_AWAITED, ONLINE };
    void take(const LinkEvent &event);
    void take_message(const Publication &message);
    void take_state(std::string_view payload);
    void take_receipt(std::string_view payload);
    bool isRebirthRequested(std::string_view payload) const;
    void connect();
    void connected();
    void lose(const std::string &why);
    void leave(const std::string &why);
    void bear_node();
    void bear_device();
    void bury_device();
    void follow_machine();
    void publish_live(const LiveData::State &state);
    void publish_history();
    void publish_counts(const LiveData::State &state);
    bool add_record(const Record &record, bool isHistorical, Payload &into);
    void follow_broker();
    std::string topic(std::string_view type, bool isOfDevice) const;
    void send(std::string_view type, bool isOfDevice, Payload payload);
    Publication death() const;

    NodeSettings settings_;
    LiveData &data_;
    BrokerLink &link_;
    KeepNumber keep_;
    Report report_;
    Moment now_;

    Phase phase_ = Phase::WAITING;
    double phase_end_s_ = 0, retry_s_;
    std::size_t broker_ = 0;
    bool hasReported_ = false;  ///< an unreachable broker has been reported
    std::uint64_t next_bdseq_, bdseq_ = 0;
    TimeMs birth_ = 0;  ///< time of the node's birth; strictly increasing
    std::uint8_t seq_ = 0;
    bool isRebirthDue_ = false;
    std::optional<std::uint64_t> host_at_;  ///< time of the newest STATE
    bool isHostOnline_ = false, hasReceipts_ = false;

    bool isDeviceBorn_ = false;
    std::uint64_t generation_ = 0;
    std::map<std::string, std::uint64_t, std::less<>> aliases_;  ///< aliases of the device's metrics
    Delivery delivery_;
    std::uint64_t told_dropped_ = 0;
};

}  // namespace mw::publish
