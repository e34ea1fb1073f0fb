// SPDX-License-Identifier: GPL-2.0-or-later
// Pages that may send requests, and the rate of their requests.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::screen {

/// Data of a browser about the page that sends the request; empty if missing.
struct RequestOrigin {
    std::string_view host;    ///< header Host
    std::string_view origin;  ///< header Origin
    std::string_view site;    ///< header Sec-Fetch-Site
};

/// Accepts only pages of this server. Rejects pages of other sites, and of names that a foreign name server
/// resolves to this server.
class OriginCheck {
  public:
    /// `names` of the server in lower case, without a port; an IPv6 address in brackets. `port` at which it
    /// listens.
    OriginCheck(bool hasTls, int port, const std::vector<std::string> &names);

    /// `address`: address of this side of the connection, also a name of the server; empty: none.
    Result<> check(const RequestOrigin &asker, std::string_view path, std::string_view address = {}) const;

  private:
    bool isOurs(std::string_view host, std::string_view address) const;

    std::string scheme_, port_;
    bool isPortPreset_;
    std::vector<std::string> names_;
};

/// A token bucket of `at_once` requests that is filled at the rate `per_s`.
class RateLimit {
  public:
    RateLimit(double per_s, double at_once) : per_s_(per_s), most_(at_once), left_(at_once) {}

    /// False if the request is not permitted now. The time is monotonic.
    bool take(std::int64_t now_ns);

  private:
    double per_s_, most_, left_;
    std::int64_t last_ns_ = 0;
};

}  // namespace mw::screen
