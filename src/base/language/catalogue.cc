// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/language/catalogue.hh"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>

namespace mw::language {
namespace {

constexpr std::string_view HOLE = "{}";

/// A number of a .mo file; nothing outside the file.
std::optional<std::size_t> number_at(std::string_view mo, std::size_t at) {
    std::uint32_t number = 0;
    if (at > mo.size() || mo.size() - at < sizeof number) {
        return std::nullopt;
    }
    std::memcpy(&number, mo.data() + at, sizeof number);
    return number;
}

/// The `i`-th text of the table at `table`.
std::optional<std::string_view> text_at(std::string_view mo, std::size_t table, std::size_t i) {
    const auto length = number_at(mo, table + 8 * i), at = number_at(mo, table + 8 * i + 4);
    if (!length.has_value() || !at.has_value() || *at > mo.size() || mo.size() - *at < *length) {
        return std::nullopt;
    }
    return mo.substr(*at, *length);
}

std::vector<std::string> pieces_of(std::string_view key) {
    std::vector<std::string> pieces;
    for (std::size_t hole = 0; (hole = key.find(HOLE)) != std::string_view::npos;) {
        pieces.emplace_back(key.substr(0, hole));
        key.remove_prefix(hole + HOLE.size());
    }
    pieces.emplace_back(key);
    return pieces;
}

/// The texts between the pieces in `text`; nothing if `text` does not consist of the pieces in this order.
std::optional<std::vector<std::string_view>> values_between(const std::vector<std::string> &pieces,
                                                            std::string_view text) {
    if (!text.starts_with(pieces.front())) {
        return std::nullopt;
    }
    text.remove_prefix(pieces.front().size());
    std::vector<std::string_view> values;
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        const bool is_last = i + 1 == pieces.size();
        const std::string &piece = pieces[i];
        const bool at_end = is_last && text.ends_with(piece);
        const std::size_t at = is_last ? text.size() - piece.size() : text.find(piece);
        if (is_last ? !at_end : at == std::string_view::npos) {
            return std::nullopt;
        }
        values.push_back(text.substr(0, at));
        text.remove_prefix(at + piece.size());
    }
    return values;
}

/// Number of words with at least two letters.
std::size_t count_words(const std::vector<std::string> &pieces) {
    std::size_t words = 0;
    for (const std::string &piece : pieces) {
        std::size_t letters = 0;
        for (const unsigned char c : piece) {
            letters = std::isalpha(c) != 0 ? letters + 1 : 0;
            words += letters == 2 ? 1 : 0;
        }
    }
    return words;
}

/// A value of one word is a name or a number: a signal may be named "error".
bool hasSeveralWords(std::string_view text) {
    return text.find(' ') != std::string_view::npos &&
           std::count_if(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0; }) > 2;
}

}  // namespace

Result<Catalogue> Catalogue::read(std::string_view mo) {
    constexpr std::size_t MAGIC = 0x950412de;
    const auto magic = number_at(mo, 0), count = number_at(mo, 8), keys = number_at(mo, 12),
               texts = number_at(mo, 16);
    if (magic != MAGIC || !texts.has_value()) {
        return fail("this is no catalogue of gettext for this computer");
    }
    Catalogue made;
    for (std::size_t i = 0; i < *count; ++i) {
        const auto key = text_at(mo, *keys, i), text = text_at(mo, *texts, i);
        if (!key.has_value() || !text.has_value()) {
            return fail("the catalogue ends within its texts");
        }
        if (!key->empty() && !text->empty()) {
            made.add(*key, *text);
        }
    }
    std::ranges::stable_sort(made.patterns_, std::greater<>{}, &Pattern::letters);
    return made;
}

void Catalogue::add(std::string_view key, std::string_view translation) {
    Pattern made{.pieces = pieces_of(key), .translation = std::string(translation)};
    if (made.pieces.size() == 1) {
        whole_.emplace(key, translation);
        return;
    }
    for (const std::string &piece : made.pieces) {
        made.letters += piece.size();
    }
    made.is_name = count_words(made.pieces) < 2;
    patterns_.push_back(std::move(made));
}

std::optional<std::string> Catalogue::find(std::string_view english) const {
    int left = MAX_LOOKUPS;
    return find(english, Depth{0, &left});
}

std::optional<std::string> Catalogue::find(std::string_view english, Depth depth) const {
    if (--*depth.left < 0) {
        return std::nullopt;
    }
    if (const auto found = whole_.find(std::string(english)); found != whole_.end()) {
        return found->second;
    }
    for (const Pattern &pattern : patterns_) {
        if (const auto values = values_between(pattern.pieces, english);
            values && isFitting(pattern, *values, depth)) {
            return filled(pattern, *values, depth + 1);
        }
    }
    return std::nullopt;
}

/// If a value is a sentence (for instance after "joint"), the text is another message without a translation.
/// A position, a name or a sentence with a colon at the beginning of the text is a separate part and not a
/// value.
bool Catalogue::isFitting(const Pattern &pattern, const std::vector<std::string_view> &values,
                          Depth depth) const {
    if (pattern.pieces.front().empty() && values.front().find(": ") != std::string_view::npos) {
        return false;
    }
    return !pattern.is_name || std::ranges::all_of(values, [&](std::string_view value) {
        return value.find(' ') == std::string_view::npos ||
               (!depth.isDeepest() && composed(value, depth + 1).has_value());
    });
}

std::string Catalogue::filled(const Pattern &pattern, const std::vector<std::string_view> &values,
                              Depth depth) const {
    std::string out;
    std::size_t next = 0;
    const std::string &text = pattern.translation;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const bool numbered = text.compare(at, 1, "{") == 0 && at + 2 < text.size() && text[at + 2] == '}';
        const bool is_next = text.compare(at, HOLE.size(), HOLE) == 0;
        if (!is_next && !(numbered && text[at + 1] >= '0' && text[at + 1] <= '9')) {
            out += text[at];
            continue;
        }
        const std::size_t which = is_next ? next++ : static_cast<std::size_t>(text[at + 1] - '0');
        const std::string_view value = which < values.size() ? values[which] : std::string_view{};
        out += !depth.isDeepest() && hasSeveralWords(value)
                   ? composed(value, depth).value_or(std::string(value))
                   : std::string(value);
        at += is_next ? 1 : 2;
    }
    return out;
}

/// Translates "MESSAGE (HINT)".
std::optional<std::string> Catalogue::with_hint(std::string_view english, Depth depth) const {
    if (!english.ends_with(')')) {
        return std::nullopt;
    }
    for (std::size_t at = english.find(" ("); at != std::string_view::npos; at = english.find(" (", at + 1)) {
        const std::string_view head = english.substr(0, at);
        const std::string_view hint = english.substr(at + 2, english.size() - at - 3);
        const auto said = composed(head, depth + 1), advised = composed(hint, depth + 1);
        if (said.has_value() || advised.has_value()) {
            return said.value_or(std::string(head)) + " (" + advised.value_or(std::string(hint)) + ")";
        }
    }
    return std::nullopt;
}

/// Translates a name with a suffix (" needs a value"): the key of the suffix begins with a blank or a colon.
std::optional<std::string> Catalogue::with_ending(std::string_view english, Depth depth) const {
    for (std::size_t at = english.find_first_of(" :", 1); at != std::string_view::npos;
         at = english.find_first_of(" :", at + 1)) {
        if (--*depth.left < 0) {
            return std::nullopt;
        }
        const std::string_view ending = english.substr(at);
        if (const auto found = whole_.find(std::string(ending)); found != whole_.end()) {
            return std::string(english.substr(0, at)) + found->second;
        }
        for (const Pattern &pattern : patterns_) {
            const auto values = pattern.pieces.front().starts_with(ending.front())
                                    ? values_between(pattern.pieces, ending)
                                    : std::nullopt;
            if (values.has_value()) {
                return std::string(english.substr(0, at)) + filled(pattern, *values, depth + 1);
            }
        }
    }
    return std::nullopt;
}

/// Translates "PLACE: MESSAGE", "MESSAGE: MESSAGE", "MESSAGE; MESSAGE".
std::optional<std::string> Catalogue::in_parts(std::string_view english, Depth depth) const {
    for (const std::string_view between : {": ", "; "}) {
        for (std::size_t at = english.find(between); at != std::string_view::npos;
             at = english.find(between, at + 1)) {
            const std::string_view head = english.substr(0, at), rest = english.substr(at + between.size());
            const auto said = find(head, depth + 1), more = composed(rest, depth + 1);
            if (said.has_value() || more.has_value()) {
                return said.value_or(std::string(head)) + std::string(between) +
                       more.value_or(std::string(rest));
            }
        }
    }
    return std::nullopt;
}

std::optional<std::string> Catalogue::composed(std::string_view english, Depth depth) const {
    if (auto found = find(english, depth); found.has_value() || depth.isDeepest()) {
        return found;
    }
    auto found = with_hint(english, depth);
    found = found.has_value() ? found : in_parts(english, depth);
    return found.has_value() ? found : with_ending(english, depth);
}

std::string Catalogue::shown(std::string_view english) const {
    if (isEmpty()) {
        return std::string(english);
    }
    constexpr std::string_view END = "\r\n";
    const std::size_t first = std::min(english.find_first_not_of(END), english.size());
    const std::size_t last = english.find_last_not_of(END);
    const std::size_t length = last == std::string_view::npos ? 0 : last + 1 - first;
    const std::string_view core = english.substr(first, length);
    std::string out(english.substr(0, first));
    if (const auto whole = find(core)) {
        out += *whole;
    } else if (const std::size_t line = core.find('\n'); line != std::string_view::npos) {
        out += shown(core.substr(0, line)) + '\n' + shown(core.substr(line + 1));
    } else if (constexpr std::string_view CALLER = "  "; core.starts_with(CALLER)) {
        const auto caller =
            core.starts_with("  called from ") ? find(core.substr(CALLER.size())) : std::nullopt;
        out += caller.has_value() ? std::string(CALLER) + *caller : std::string(core);
    } else {
        int left = MAX_LOOKUPS;
        out += composed(core, Depth{0, &left}).value_or(std::string(core));
    }
    return out + std::string(english.substr(first + length));
}

}  // namespace mw::language
