// SPDX-License-Identifier: GPL-2.0-or-later
// The texts of one language. Messages are created and sent in English. The program that shows a message
// searches this catalogue for its pattern. So texts need no marks in the sources, and each user can have a
// different language.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.hh"

namespace mw::language {

/// Immutable after reading. [any thread, not realtime]
class Catalogue {
  public:
    /// Reads a compiled gettext catalogue (.mo) in UTF-8. Keys are English with {} for values; translations
    /// have {} in the same order, or {0}, {1}. Texts without a translation are omitted.
    static Result<Catalogue> read(std::string_view mo);

    bool isEmpty() const { return whole_.empty() && patterns_.empty(); }
    /// Translation of one complete English text, by the matching key with the most letters. Values are
    /// translated as well if they are texts of the catalogue.
    std::optional<std::string> find(std::string_view english) const;
    /// Translates a message as printed: "FILE:LINE:COLUMN: error: MESSAGE (HINT)", several lines, several
    /// sentences. Unknown parts remain English. Program lines (they begin with blanks) are not changed.
    std::string shown(std::string_view english) const;

  private:
    struct Pattern {
        std::vector<std::string> pieces;  ///< pieces of the key between values
        std::size_t letters = 0;          ///< letters of all pieces
        bool is_name = false;             ///< a single word, as in "joint {}": the value is a name
        std::string translation;
    };
    /// Nesting depth of a text, and the number of look-ups left for one message. It bounds the search in a
    /// message that has unknown words and many colons.
    struct Depth {
        int level = 0;
        int *left = nullptr;
        Depth operator+(int more) const { return {level + more, left}; }
        bool isDeepest() const { return level >= MAX_DEPTH || *left <= 0; }
    };
    static constexpr int MAX_DEPTH = 5;
    static constexpr int MAX_LOOKUPS = 2000;
    void add(std::string_view key, std::string_view translation);
    std::optional<std::string> find(std::string_view english, Depth depth) const;
    bool isFitting(const Pattern &pattern, const std::vector<std::string_view> &values, Depth depth) const;
    std::optional<std::string> composed(std::string_view english, Depth depth) const;
    std::optional<std::string> with_hint(std::string_view english, Depth depth) const;
    std::optional<std::string> with_ending(std::string_view english, Depth depth) const;
    std::optional<std::string> in_parts(std::string_view english, Depth depth) const;
    std::string filled(const Pattern &pattern, const std::vector<std::string_view> &values,
                       Depth depth) const;

    std::unordered_map<std::string, std::string> whole_;
    std::vector<Pattern> patterns_;  ///< sorted by number of letters, descending
};

}  // namespace mw::language
