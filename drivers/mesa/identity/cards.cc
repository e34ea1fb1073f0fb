// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/identity/cards.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr Card CARDS[] = {
    {"7I76E", "7i76e", 3, 17, {"on card", "P1", "P2"}},
    {"7I80DB", "7i80", 4, 17, {"J2", "J3", "J4", "J5"}},
    {"7I80HD", "7i80", 3, 24, {"P1", "P2", "P3"}},
    {"7I92", "7i92", 2, 17, {"P2", "P1"}},
    {"7I93", "7i93", 2, 24, {"P2", "P1"}},
    {"7I94", "7i94", 2, 21, {}},
    {"7I95", "7i95", 2, 29, {}},
    {"7I96S", "7i96s", 3, 17, {"P1", "TB1", "TB2"}},
    {"7I96", "7i96", 3, 17, {"P1", "TB1", "TB2"}},
    {"7I97", "7i97", 3, 17, {}},
    {"7I98", "7i98", 3, 17, {"P1", "P2", "P3"}},
    {"MC04", "mc04", 2, 30, {}},
    {"8CSS", "8css", 2, 30, {}},
};

}  // namespace

std::span<const Card> ethernet_cards() noexcept {
    return CARDS;
}

const Card *find_ethernet_card(std::string_view reported_name) noexcept {
    const auto *card = std::ranges::find_if(
        CARDS, [&](const Card &one) { return reported_name.starts_with(one.name_begins); });
    return card == std::end(CARDS) ? nullptr : card;
}

}  // namespace mw::mesa
