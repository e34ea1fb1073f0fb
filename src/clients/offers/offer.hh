// SPDX-License-Identifier: GPL-2.0-or-later
// A program that a shop offers to a machine, with its subroutines. An offer is a text: it cannot start, open
// or change anything. A person at the machine accepts or declines it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::offers {

/// Milliseconds of UTC since 1970.
using TimeMs = std::uint64_t;

struct OfferedFile {
    std::string name;  ///< without a folder
    std::string text;  ///< UTF-8

    bool operator==(const OfferedFile &) const = default;
};

struct Offer {
    std::string id;                  ///< UUID in lower case, unique in all shops
    std::string from;                ///< the person who offers it
    std::string note;                ///< text for the operator; may be empty
    int parts = 0;                   ///< number of parts to make; 0: not set
    std::string sha256;              ///< of the files, as sha256_of() calculates it
    std::vector<OfferedFile> files;  ///< the program, then its subroutines

    const std::string &name() const { return files.front().name; }
    std::uint64_t bytes() const;
    bool operator==(const Offer &) const = default;
};

/// Limits of an offer. The text of all files together, in bytes.
inline constexpr std::size_t MOST_TEXT_BYTES = std::size_t{4} << 20U, MOST_FILES = 32, MOST_NAME_BYTES = 200,
                             MOST_NOTE_BYTES = 2000, MOST_PERSON_BYTES = 100;
inline constexpr int MOST_PARTS = 1'000'000;
/// Maximum size of an encoded offer: in JSON a control character takes up to six bytes.
inline constexpr std::size_t MOST_MESSAGE_BYTES = 2 * MOST_TEXT_BYTES;

/// SHA-256 over each file: its name, a zero byte, its length in decimal, a zero byte, its text. In lower-case
/// hexadecimal.
std::string sha256_of(const std::vector<OfferedFile> &files);

/// In lower-case hexadecimal.
std::string sha256_of_bytes(std::string_view bytes);

bool isOfferId(std::string_view text);
/// Printable UTF-8 without control characters, line breaks included.
bool isPlainText(std::string_view text);
/// The reason why a file of an offer cannot have this name; empty if it can. A name has no folder and the
/// extension of a program, so that no filter runs it.
std::string check_name(std::string_view name);
/// One error for the first rule of this file that the offer breaks.
Result<> check(const Offer &offer);

std::string encode(const Offer &offer);
/// A checked offer.
Result<Offer> decode_offer(std::string_view json);

enum class State : std::uint8_t {
    SENT,       ///< waits for the machine
    RECEIVED,   ///< waits for the operator
    ACCEPTED,   ///< its files are programs of the machine
    DECLINED,   ///< by the operator
    WITHDRAWN,  ///< by the shop
    REJECTED    ///< by the machine: it breaks a rule
};
std::string_view name_of(State state);
std::optional<State> state_of(std::string_view name);
/// A final state never changes.
inline bool isFinal(State state) {
    return state != State::SENT && state != State::RECEIVED;
}

}  // namespace mw::offers
