// SPDX-License-Identifier: GPL-2.0-or-later
// Text tables of the simulated board (models, physics, faults). Each line has a type, an optional name, and
// values as KEY=VALUE. "#" begins a comment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::mesa::board {

/// One KEY=VALUE.
struct TableValue {
    std::string key, value;
    SourcePlace place;  ///< position of the key
    bool used = false;
};

/// A line that is not a comment. The first error of an access is stored, so that a caller checks only once,
/// at the end.
class TableLine {
  public:
    /// Splits `text`, which is line `place.line` of its file.
    static Result<TableLine> parse(std::string_view text, const SourcePlace &place);

    /// The first word: the type of the line.
    const std::string &type() const { return type_; }
    /// The second word; empty if there is none.
    const std::string &name() const { return name_; }
    const SourcePlace &place() const { return place_; }

    /// A whole number (decimal or 0x...) from `low` to `high`. If `fallback` is empty, a missing value is an
    /// error.
    std::int64_t whole(std::string_view key, std::int64_t low, std::int64_t high,
                       std::optional<std::int64_t> fallback = {});
    double number(std::string_view key, double low, double high, std::optional<double> fallback = {});
    std::string text(std::string_view key, std::optional<std::string> fallback = {});
    /// The index of the word in `words`.
    std::size_t choice(std::string_view key, const std::vector<std::string> &words,
                       std::optional<std::size_t> fallback = {});
    bool has(std::string_view key) const;

    /// Stores an error about the value of `key`, or about the line if it has no such value.
    void reject(std::string_view key, std::string message);
    /// Returns the first error; a value that was not read is an error, too.
    Result<> finish();

  private:
    TableValue *find(std::string_view key);
    TableValue *required(std::string_view key, bool optional);

    std::string type_, name_;
    SourcePlace place_;
    std::vector<TableValue> values_;
    std::optional<Error> error_;
};

/// The lines of a whole text; `file` is its name in errors.
Result<std::vector<TableLine>> parse_table(std::string_view text, const std::string &file);

}  // namespace mw::mesa::board
