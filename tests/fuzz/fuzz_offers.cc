// SPDX-License-Identifier: GPL-2.0-or-later
// Messages between a shop and a machine about offers.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "clients/offers/exchange.hh"

namespace {

void require(bool isTrue) {
    if (!isTrue) {
        std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using namespace mw::offers;
    const std::string_view text(reinterpret_cast<const char *>(data), size);
    if (const auto reply = decode_reply(text); reply.has_value() && !reply->broken.has_value()) {
        require(!reply->offer.has_value() || check(*reply->offer).has_value());
        const auto again = decode_reply(encode(*reply));
        require(again.has_value() && again->offer == reply->offer && again->noted == reply->noted);
    }
    if (const auto report = decode_report(text); report.has_value()) {
        require(decode_report(encode(*report)).value() == *report);
    }
    if (const auto offer = decode_offer(text); offer.has_value()) {
        require(decode_offer(encode(*offer)).value() == *offer);
    }
    return 0;
}
