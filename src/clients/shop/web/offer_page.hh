// SPDX-License-Identifier: GPL-2.0-or-later
// The part of the shop page that offers programs to machines. It writes only the tables of offers.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "clients/screen/http/http_types.hh"
#include "clients/shop/store/database.hh"

namespace mw::shop {

/// Maximum size of a request to the page. [bytes]
inline constexpr std::size_t MOST_REQUEST_BYTES = std::size_t{5} << 20U;

/// For one thread, that of the server. An answer waits for the database.
class OfferPage {
  public:
    explicit OfferPage(std::string database) : name_(std::move(database)) {}

    /// GET /offers: the newest offers with their states. POST /offers: offers a program, role OPERATE. POST
    /// /offers/withdraw, role OPERATE. GET /copies: versions of collected files. GET /copies/ID: one of them,
    /// role OPERATE.
    screen::Response answer(const screen::Request &request);

  private:
    screen::Response list();
    screen::Response add(const std::string &body);
    screen::Response copy(const screen::Request &request);
    screen::Response withdraw(const std::string &body);
    Result<std::string> ask(const std::string &sql, std::span<const Parameter> parameters = {});
    screen::Response written(const std::string &sql, std::span<const Parameter> parameters);

    std::string name_;
    std::optional<Database> database_;
};

}  // namespace mw::shop
