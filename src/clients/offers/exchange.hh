// SPDX-License-Identifier: GPL-2.0-or-later
// The two messages between a machine and a shop. The machine reports the states of its offers, the shop
// replies. Both are repeated until they agree, so a lost or repeated message has no effect.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/offers/offer.hh"

namespace mw::offers {

/// The state of an offer at the machine.
struct Standing {
    std::string id{};
    State state = State::RECEIVED;
    TimeMs at = 0;         ///< time of the machine
    std::string by{};      ///< the person at the machine; empty: no person
    std::string reason{};  ///< of a declined or rejected offer; may be empty

    bool operator==(const Standing &) const = default;
};

/// A version of a file of the machine that the shop collects.
struct CopyFacts {
    std::string kind{};    ///< "tools": the tool table
    std::string sha256{};  ///< of its bytes
    TimeMs at = 0;         ///< when the file was written, time of the machine

    bool operator==(const CopyFacts &) const = default;
};

struct Copy {
    CopyFacts facts{};
    std::string name{};   ///< of the file, without a folder
    std::string bytes{};  ///< any bytes

    bool operator==(const Copy &) const = default;
};
inline constexpr std::size_t MOST_COPY_BYTES = std::size_t{1} << 20U, MOST_COPIES = 8;

/// From a machine.
struct Report {
    std::vector<Standing> changes{};  ///< those that the shop has not noted
    std::vector<std::string> open{};  ///< ids of all offers that wait for the operator
    std::vector<CopyFacts> copies{};  ///< the current versions
    bool hasRoom = true;              ///< it takes another offer

    bool operator==(const Report &) const = default;
};

/// The shop has stored this state.
struct Note {
    std::string id;
    State state = State::RECEIVED;

    bool operator==(const Note &) const = default;
};

/// An offer that breaks a rule.
struct BrokenOffer {
    std::string id, why;
};

/// From the shop.
struct Reply {
    std::vector<Note> noted{};
    std::vector<std::string> withdrawn{};  ///< ids
    std::vector<std::string> wanted{};     ///< kinds of copies that the shop does not have
    std::optional<Offer> offer{};          ///< one offer in each reply
    std::optional<BrokenOffer> broken{};   ///< instead of an offer; never sent

    bool isEmpty() const { return noted.empty() && withdrawn.empty() && !offer.has_value(); }
};

/// Maximum number of entries of each list.
inline constexpr std::size_t MOST_ENTRIES = 100;

std::string report_topic(std::string_view host, std::string_view group, std::string_view node,
                         std::string_view device);
std::string copy_topic(std::string_view host, std::string_view group, std::string_view node,
                       std::string_view device);
std::string reply_topic(std::string_view host, std::string_view group, std::string_view node,
                        std::string_view device);

std::string encode(const Report &report);
Result<Report> decode_report(std::string_view json);
std::string encode(const Copy &copy);
/// A copy whose hash fits its bytes.
Result<Copy> decode_copy(std::string_view json);
std::string encode(const Reply &reply);
/// An offer with a valid id that breaks a rule becomes `broken`; other errors reject the message.
Result<Reply> decode_reply(std::string_view json);

}  // namespace mw::offers
