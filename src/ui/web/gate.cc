// SPDX-License-Identifier: GPL-2.0-or-later
#include "ui/web/gate.hh"

#include <algorithm>

#include "base/text.hh"

namespace mw::ui::web {

Gate::Gate(int port) {
    constexpr int PORT_OF_HTTP = 80;
    for (const char *name : {"127.0.0.1", "localhost"}) {
        hosts_.push_back(std::string(name) + ':' + std::to_string(port));
        if (port == PORT_OF_HTTP) {
            hosts_.emplace_back(name);
        }
    }
}

Result<> Gate::check(const Asker &asker, std::string_view path) const {
    const auto isOurs = [this](std::string_view host) {
        return std::ranges::find(hosts_, to_lower(host)) != hosts_.end();
    };
    if (!isOurs(asker.host)) {
        return fail("'" + printable(asker.host) + "' is no name of this server: open http://" + hosts_[0]);
    }
    constexpr std::string_view SCHEME = "http://";
    const bool isOwnPage = asker.origin.empty() ||
                           (asker.origin.starts_with(SCHEME) && isOurs(asker.origin.substr(SCHEME.size())));
    const bool isOwnSite = asker.site.empty() || asker.site == "same-origin" || asker.site == "none" ||
                           !path.starts_with("/api/");
    return isOwnPage && isOwnSite ? Result<>{} : fail("pages of other sites may ask nothing here");
}

bool RateLimit::take(std::int64_t now_ns) {
    left_ = std::min(most_, left_ + static_cast<double>(now_ns - last_ns_) * 1e-9 * per_s_);
    last_ns_ = now_ns;
    if (left_ < 1) {
        return false;
    }
    left_ -= 1;
    return true;
}

}  // namespace mw::ui::web
