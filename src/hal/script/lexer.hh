// SPDX-License-Identifier: GPL-2.0-or-later
// Lines and words of the HAL file language, with the position of each character. Processing of a line:
// physical lines are joined at a final backslash; comments are removed; environment and INI variables are
// substituted (also inside quotes); the result is split into words at blanks, with quotes grouping.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::hal::script {

/// Source of `[SECTION]NAME`, implemented by the owner of the INI file.
class IniLookup {
  public:
    virtual ~IniLookup() = default;
    /// The value of the first entry NAME in SECTION; nothing when there is none.
    virtual std::optional<std::string> find(std::string_view section, std::string_view name) const = 0;
    /// The names in SECTION (for hints); empty when the section does not exist.
    virtual std::vector<std::string> names(std::string_view section) const = 0;
    /// All values of NAME in SECTION, in order.
    virtual std::vector<std::string> values(std::string_view section, std::string_view name) const {
        const std::optional<std::string> value = find(section, name);
        return value ? std::vector<std::string>{*value} : std::vector<std::string>{};
    }
    virtual std::vector<std::string> sections() const { return {}; }
};

/// Text with the line and column of every character.
class PlacedText {
  public:
    struct Position {
        int line = 0;
        int column = 0;
    };

    void append(char c, Position position);
    /// Appends text that has one position (a substituted value).
    void append(std::string_view text, Position position);
    void truncate(std::size_t size);

    const std::string &text() const { return text_; }
    std::size_t size() const { return text_.size(); }
    /// Position of character `i`; after the end, that of the last character plus one.
    Position at(std::size_t i) const;

  private:
    std::string text_;
    std::vector<Position> positions_;
};

/// Text of one command: a line with its continuations, without comment.
struct LogicalLine {
    PlacedText text;
    int first_line = 0;
};

/// A word of a command. `text` is without quotes, `raw` is unchanged (after substitution).
struct Word {
    std::string text;
    std::string raw;
    SourcePlace place;
};

/// Splits `source`, whose first line has the number `first_line`, into logical lines without empty ones.
std::vector<LogicalLine> split_lines(std::string_view source, int first_line = 1);

/// The environment and INI file for variables.
struct Variables {
    /// Value of an environment variable, nothing when it is not set. Null: the environment of the process.
    std::optional<std::string> (*environment)(const std::string &name) = nullptr;
    const IniLookup *ini = nullptr;  ///< null: `[SECTION]NAME` is an error
};

/// Replaces $VAR, $(VAR), [SECTION]VAR and [SECTION](VAR). A name without parentheses ends at a blank.
Result<PlacedText> substitute(const PlacedText &line, const std::string &file, const Variables &variables);

/// Splits at blanks; a quoted part ('..' or "..") is not split.
Result<std::vector<Word>> split_words(const PlacedText &line, const std::string &file);

/// True for the arrows =>, <=, <=> and their longer forms: words that only document a direction.
bool isArrow(std::string_view word);

}  // namespace mw::hal::script
