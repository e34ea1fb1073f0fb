// SPDX-License-Identifier: GPL-2.0-or-later
// The page of all machines. It reads the database, and writes only offers.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "clients/screen/http/http_types.hh"
#include "clients/shop/store/database.hh"
#include "clients/shop/web/offer_page.hh"

namespace mw::shop {

/// For one thread, that of the server. An answer waits for the database.
class ShopPage final : public screen::Application {
  public:
    /// `steady_s`: a monotonic time.
    ShopPage(std::string database, std::function<double()> steady_s);

    /// GET / : the page. GET /machines: states of all machines. GET /machines/sums: their current shift. GET
    /// /machines/history?machine=ID&days=N: one machine. /offers: see OfferPage.
    void answer(const screen::Request &request, screen::Reply reply) override;
    void opened(screen::SessionId, screen::Role, screen::Protection) override {}
    void received(screen::SessionId, std::string_view) override {}
    void closed(screen::SessionId) override {}

  private:
    /// An answer that is calculated again when it is too old.
    struct Kept {
        std::string sql;
        double fresh_s = 1;
        std::string json{};
        double fresh_until_s = -1;
    };
    screen::Response kept(Kept &answer);
    screen::Response history(const screen::Request &request);
    Result<std::string> ask(const std::string &sql, std::span<const Parameter> parameters = {});

    std::string name_;
    OfferPage offers_;
    std::function<double()> steady_s_;
    std::optional<Database> database_;
    Kept machines_{.sql = "SELECT page_machines()", .fresh_s = 1};
    Kept sums_{.sql = "SELECT page_sums()", .fresh_s = 10};
};

}  // namespace mw::shop
