// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/access/origin_check.hh"

#include <algorithm>

#include "base/text.hh"

namespace mw::screen {

OriginCheck::OriginCheck(bool has_tls, int port, const std::vector<std::string> &names)
    : scheme_(has_tls ? "https://" : "http://"), port_(":" + std::to_string(port)),
      isPortPreset_(port == (has_tls ? 443 : 80)), names_(names) {}

bool OriginCheck::isOurs(std::string_view host, std::string_view address) const {
    const std::string asked = to_lower(host);
    const auto isNamed = [&](std::string_view name) {
        const bool is_start = !name.empty() && asked.starts_with(name);
        const std::string_view rest = is_start ? std::string_view(asked).substr(name.size()) : "";
        return is_start && (rest == port_ || (rest.empty() && isPortPreset_));
    };
    return isNamed(address) || std::ranges::any_of(names_, isNamed);
}

Result<> OriginCheck::check(const RequestOrigin &asker, std::string_view path,
                            std::string_view address) const {
    if (!isOurs(asker.host, address)) {
        const std::string_view known = names_.empty() ? address : std::string_view(names_[0]);
        return fail("'" + printable(asker.host) + "' is no name of this server: open " + scheme_ +
                    std::string(known) + port_);
    }
    const bool own_page = asker.origin.empty() || (asker.origin.starts_with(scheme_) &&
                                                   isOurs(asker.origin.substr(scheme_.size()), address));
    const bool own_site = asker.site.empty() || asker.site == "same-origin" || asker.site == "none" ||
                          !path.starts_with("/api/");
    return own_page && own_site ? Result<>{} : fail("pages of other sites may ask nothing here");
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

}  // namespace mw::screen
