// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps the host application connected while the store works, and passes batches to the store.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "clients/publish/sparkplug/broker_link.hh"
#include "clients/shop/host/host_application.hh"
#include "clients/shop/store/store_thread.hh"

namespace mw::shop {

struct CollectorSettings {
    std::size_t brokers = 1;
    double retry_s = 1;    ///< interval between two attempts to connect
    double answer_s = 10;  ///< timeout of a connection
    /// A store that takes longer for a batch counts as unavailable. Machines then keep their values until it
    /// is back.
    double store_s = 5;
    double batch_s = 0.1;                 ///< interval between two batches
    std::size_t most_readings = 500'000;  ///< maximum in memory; above it the store is too slow
};

/// Values that are not committed in the database get no receipt, and the machine sends values without a
/// receipt again. So the collector stores nothing itself: when the store or the broker is lost it drops
/// everything, and is offline until both are available. All calls come from one thread.
class Collector {
  public:
    using Moment = HostApplication::Moment;
    using Report = std::function<void(const std::string &)>;
    /// Called for each batch before it is stored.
    using Watch = std::function<void(const Batch &)>;

    Collector(CollectorSettings settings, HostSettings host, publish::BrokerLink &link, StoreThread &store,
              Report report);

    void set_watch(Watch watch) { watch_ = std::move(watch); }
    void step(const Moment &now);
    /// Reports that the host is offline, and disconnects.
    void end();

  private:
    enum class Phase : std::uint8_t { WAITING, CONNECTING, ONLINE };
    void take(const publish::LinkEvent &event);
    bool isStoreWorking();
    void lose(const std::string &why);
    void leave(const std::string &why);
    void give_batch();

    CollectorSettings settings_;
    publish::BrokerLink &link_;
    StoreThread &store_;
    Report report_;
    Watch watch_;
    HostApplication host_;
    Moment now_;
    Phase phase_ = Phase::WAITING;
    double phase_end_s_ = 0, batch_s_ = 0;
    std::size_t broker_ = 0;
    int opened_ = 0;  ///< the store that this connection uses
    bool hasReported_ = false;
};

}  // namespace mw::shop
