// SPDX-License-Identifier: GPL-2.0-or-later
// Receives the offers of a shop into the folder of a machine, and reports their states. It uses neither
// sockets nor clocks, and cannot reach the machine.
#pragma once

#include <functional>
#include <string>

#include "clients/offers/offer_box.hh"
#include "clients/publish/offers/copy_source.hh"
#include "clients/publish/sparkplug/broker_link.hh"

namespace mw::publish {

struct OfferSettings {
    std::string host, group, node, device;   ///< parts of the topics
    std::size_t brokers = 1;                 ///< number of brokers in the list
    std::vector<CopySource::File> copies{};  ///< files that the shop collects
    double report_s = 5;                     ///< interval between two reports
    double first_retry_s = 1, longest_retry_s = 30;
    double answer_s = 10;   ///< timeout of a connection
    double silence_s = 60;  ///< without a reply for this time, the shop may be at another broker
};

/// Reports every report_s, and at once after each change. The connection is separate from that of the values,
/// so a large offer delays no value. All calls come from one thread.
class OfferSession {
  public:
    struct Moment {
        offers::TimeMs utc_ms = 0;
        double at_s = 0;
    };
    using Tell = std::function<void(const std::string &)>;

    OfferSession(OfferSettings settings, offers::OfferBox &box, BrokerLink &link, Tell tell);

    void step(const Moment &now);
    void end();

  private:
    enum class Phase : std::uint8_t { WAITING, CONNECTING, ONLINE };
    void take(const LinkEvent &event);
    void take_reply(std::string_view payload);
    void take_offer(const offers::Reply &reply);
    void connect();
    void lose();
    void report();
    /// Reports a problem of the folder, once until another one follows.
    void tell_trouble(const Result<> &done);

    OfferSettings settings_;
    offers::OfferBox &box_;
    CopySource copies_;
    BrokerLink &link_;
    Tell tell_;
    Moment now_;
    Phase phase_ = Phase::WAITING;
    double phase_end_s_ = 0, retry_s_, report_s_ = 0, reply_s_ = 0;
    std::size_t broker_ = 0;
    std::uint64_t version_ = 0;  ///< of the reported offers
    std::string trouble_;
};

}  // namespace mw::publish
