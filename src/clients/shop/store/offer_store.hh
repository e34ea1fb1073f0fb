// SPDX-License-Identifier: GPL-2.0-or-later
// The offers of a shop in PostgreSQL.
#pragma once

#include <optional>
#include <string>

#include "clients/shop/offers/offer_desk.hh"
#include "clients/shop/store/database.hh"

namespace mw::shop {

/// All calls come from one thread.
class OfferStore final : public OfferLedger {
  public:
    /// `collector`: two desks with one name never answer at the same time.
    OfferStore(std::string database, std::string collector)
        : name_(std::move(database)), collector_(std::move(collector)) {}

    /// Connects, and takes the lock of the name. The tables exist when the collector has opened its store.
    Result<> open();
    /// False after an error, which may be one of the connection.
    bool isOpen() const { return database_.has_value(); }

    Result<offers::Reply> take(const MachineName &machine, const offers::Report &report) override;
    Result<> take(const MachineName &machine, const offers::Copy &copy) override;

  private:
    std::string name_, collector_;
    std::optional<Database> database_;
};

}  // namespace mw::shop
