// SPDX-License-Identifier: GPL-2.0-or-later
// Answers the reports of machines about their offers. The store decides; this class has no state of offers,
// so it may be killed at any time. It uses neither sockets nor clocks.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "clients/offers/exchange.hh"
#include "clients/publish/sparkplug/broker_link.hh"
#include "clients/shop/reading.hh"

namespace mw::shop {

/// The offers of a shop.
class OfferLedger {
  public:
    OfferLedger() = default;
    OfferLedger(const OfferLedger &) = delete;
    OfferLedger &operator=(const OfferLedger &) = delete;
    virtual ~OfferLedger() = default;

    /// Stores the states of a report, then returns the reply. Nothing is stored after an error. May wait for
    /// the database.
    virtual Result<offers::Reply> take(const MachineName &machine, const offers::Report &report) = 0;
    /// Stores a version once.
    virtual Result<> take(const MachineName &machine, const offers::Copy &copy) = 0;
};

struct DeskSettings {
    std::string name;                 ///< of the host application
    std::vector<std::string> groups;  ///< empty: all
    std::size_t brokers = 1;
    double retry_s = 1, answer_s = 10;
    double resend_s = 30;  ///< an offer is sent again after this time, if the machine does not confirm it
};

/// The only messages that it sends are replies to reports. All calls come from one thread.
class OfferDesk {
  public:
    using Tell = std::function<void(const std::string &)>;

    OfferDesk(DeskSettings settings, publish::BrokerLink &link, OfferLedger &ledger, Tell tell);

    void step(double now_s);
    void end();

  private:
    enum class Phase : std::uint8_t { WAITING, CONNECTING, ONLINE };
    /// The offer that was sent to a machine last.
    struct Sent {
        std::string id;
        double at_s = 0;
    };
    void take(const publish::LinkEvent &event);
    void take_report(const MachineName &machine, const publish::Publication &message);
    void take_copy(const MachineName &machine, const publish::Publication &message);
    void subscribe(const std::string &group);
    void hold_back(const MachineName &machine, offers::Reply &reply);
    std::optional<MachineName> machine_of(std::string_view kind, std::string_view topic) const;
    void lose();
    void tell_trouble(const std::string &what);

    DeskSettings settings_;
    publish::BrokerLink &link_;
    OfferLedger &ledger_;
    Tell tell_;
    double now_s_ = 0, phase_end_s_ = 0;
    Phase phase_ = Phase::WAITING;
    std::size_t broker_ = 0;
    std::map<MachineName, Sent> sent_;
    std::string trouble_;
};

}  // namespace mw::shop
