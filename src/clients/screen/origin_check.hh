// SPDX-License-Identifier: GPL-2.0-or-later
// Whose pages may ask, and how often.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::screen {

/// What a browser says about the page that asks; empty where it says nothing.
struct RequestOrigin {
    std::string_view host;    ///< header Host
    std::string_view origin;  ///< header Origin
    std::string_view site;    ///< header Sec-Fetch-Site
};

/// Accepts pages of this server and no others: neither those of other sites, nor those of a name that a
/// foreign name server resolves to this server.
class OriginCheck {
  public:
    /// `names` of the server in small letters, without a port; an IPv6 address in brackets. `port` as it
    /// listens.
    OriginCheck(bool hasTls, int port, const std::vector<std::string> &names);

    /// `address`: where the connection ends on this side, a name of the server, too; empty: none.
    Result<> check(const RequestOrigin &asker, std::string_view path, std::string_view address = {}) const;

  private:
    bool isOurs(std::string_view host, std::string_view address) const;

    std::string scheme_, port_;
    bool isPortPreset_;
    std::vector<std::string> names_;
};

/// A bucket of `at_once` requests that fills by `per_s`.
class RateLimit {
  public:
    RateLimit(double per_s, double at_once) : per_s_(per_s), most_(at_once), left_(at_once) {}

    /// False: not now. Time never goes back.
    bool take(std::int64_t now_ns);

  private:
    double per_s_, most_, left_;
    std::int64_t last_ns_ = 0;
};

}  // namespace mw::screen
