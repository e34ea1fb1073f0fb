// SPDX-License-Identifier: GPL-2.0-or-later
// Errors of code outside realtime threads. An error is a returned value with its position, never an
// exception.
#pragma once

#include <expected>
#include <string>
#include <utility>

namespace mw {

/// A position in a text that a person wrote. Lines and columns count from 1; 0 means unknown.
struct SourcePlace {
    std::string file;
    int line = 0;
    int column = 0;

    /// "file:line:column" without the unknown parts; empty when nothing is known.
    std::string str() const;
};

/// The failed operation, its position, and a hint for the user. The message is complete without the hint.
struct Error {
    std::string message;
    SourcePlace place{};
    std::string hint{};
    /// True if the error was reported to a person in full, so that it is not reported again.
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

/// As fail(), for an error that has been reported to a person already; `message` is its summary for the
/// caller.
inline std::unexpected<Error> fail_told(std::string message, SourcePlace place = {}) {
    return std::unexpected(Error{std::move(message), std::move(place), {}, true});
}

}  // namespace mw
