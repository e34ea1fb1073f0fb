// SPDX-License-Identifier: GPL-2.0-or-later
// How code outside realtime says that something failed: a value with a place, never an exception.
#pragma once

#include <expected>
#include <string>
#include <utility>

namespace mw {

/// A place in a text that a person wrote. Lines and columns count from 1; 0 means unknown.
struct SourcePlace {
    std::string file;
    int line = 0;
    int column = 0;

    /// "file:line:column", leaving out what is unknown; empty when nothing is known.
    std::string str() const;
};

/// What went wrong, where, and what to do about it. The message is complete without the hint.
struct Error {
    std::string message;
    SourcePlace place{};
    std::string hint{};
    /// Whoever found it has told it to a person already, with all that belongs to it: it is not told again.
    bool isTold = false;

    /// "file:line:column: message (hint)".
    std::string str() const;
};

template <class T = void>
using Result = std::expected<T, Error>;

/// Makes the failure value of a Result.
inline std::unexpected<Error> fail(std::string message, SourcePlace place = {}, std::string hint = {}) {
    return std::unexpected(Error{std::move(message), std::move(place), std::move(hint)});
}

/// As fail(), for what a person has been told already: `message` sums it up for whoever asks.
inline std::unexpected<Error> fail_told(std::string message, SourcePlace place = {}) {
    return std::unexpected(Error{std::move(message), std::move(place), {}, true});
}

}  // namespace mw
