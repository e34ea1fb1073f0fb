// SPDX-License-Identifier: GPL-2.0-or-later
// The texts of one language. A message is made and sent in English, by whoever has it to say and with what he
// puts into it; whoever shows it looks here for the text that it was made from. So nothing marks a text in
// the sources, and each reader has his own language.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.hh"

namespace mw::language {

/// Does not change once it is read; any thread, not realtime.
class Catalogue {
  public:
    /// A compiled catalogue of gettext (.mo), in UTF-8. Keys are English with {} for what is put in;
    /// translations have {} in the same order, or {0}, {1}. What has no translation is left out.
    static Result<Catalogue> read(std::string_view mo);

    bool isEmpty() const { return whole_.empty() && patterns_.empty(); }
    /// What stands for one English text as a whole: the key with the most letters of its own that it fits to.
    /// What is put in is looked up again, and stays as it is where it is no text of ours.
    std::optional<std::string> find(std::string_view english) const;
    /// A message as it is printed: "FILE:LINE:COLUMN: error: MESSAGE (HINT)", several lines, several
    /// sentences. Parts that are not known stay English. Lines of a program (they begin with blanks) stay as
    /// they are.
    std::string shown(std::string_view english) const;

  private:
    struct Pattern {
        std::vector<std::string> pieces;  ///< of the key, between what is put in
        std::size_t letters = 0;          ///< of all pieces
        bool isName = false;  ///< one word of its own, as "joint {}": what is put in is a name, too
        std::string translation;
    };
    /// How deep a text is in another one, and how many texts may still be looked up for one message: a
    /// message of unknown words with many colons has too many parts.
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
    std::vector<Pattern> patterns_;  ///< those with more letters come first
};

}  // namespace mw::language
