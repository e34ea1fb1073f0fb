// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/remaps.hh"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::gcode::detail {
namespace {

struct GroupNumber {
    char letter;
    int number;
    Group group;
};

/// Modal groups that a remapped code may have, in the manual's numbering.
constexpr GroupNumber GROUPS[] = {
    {'g', 1, Group::MOTION},      {'m', 4, Group::STOP},    {'m', 5, Group::IO},
    {'m', 6, Group::TOOL_CHANGE}, {'m', 7, Group::SPINDLE}, {'m', 8, Group::COOLANT},
    {'m', 9, Group::OVERRIDE},    {'m', 10, Group::USER},
};
constexpr int DEFAULT_G_GROUP = 1, DEFAULT_M_GROUP = 10;

/// Codes of the dialect that may be remapped.
constexpr GCode REMAPPABLE[] = {M(0),  M(1),  M(6),  M(7),  M(8),  M(9),  M(60), M(61),
                                M(62), M(63), M(64), M(65), M(66), M(67), M(68)};

bool isWordCode(char letter) {
    return letter == 't' || letter == 's' || letter == 'f';
}

/// Reads the parts of one line; errors have its columns.
class Reader {
  public:
    explicit Reader(const RemapLine &line) : line_(line) {}

    Result<Remap> read();

  private:
    std::unexpected<Error> error(std::string message, std::size_t offset, std::string hint = {}) const;
    std::string_view next_word();
    Result<> read_code(std::string_view word);
    Result<> read_option(std::string_view word);
    Result<> read_argspec(std::string_view text, std::size_t offset);
    Result<> read_group(std::string_view text, std::size_t offset);
    Result<> set_group(int number, std::size_t offset);
    Result<> finish();
    std::size_t offset_of(std::string_view part) const {
        return static_cast<std::size_t>(part.data() - line_.text.data());
    }

    const RemapLine &line_;
    std::size_t position_ = 0;
    char letter_ = 'g';  ///< of the code
    bool has_group_ = false;
    Remap out_;
};

std::unexpected<Error> Reader::error(std::string message, std::size_t offset, std::string hint) const {
    SourcePlace place = line_.place;
    place.column += place.column > 0 ? static_cast<int>(offset) : 0;
    return fail(fmt::format("REMAP={}: {}", line_.text, message), place, std::move(hint));
}

std::string_view Reader::next_word() {
    const std::string_view text = line_.text;
    const std::size_t begin = text.find_first_not_of(" \t", position_);
    if (begin == std::string_view::npos) {
        position_ = text.size();
        return text.substr(text.size());
    }
    position_ = std::min(text.find_first_of(" \t", begin), text.size());
    return text.substr(begin, position_ - begin);
}

Result<> Reader::read_code(std::string_view word) {
    out_.name = to_upper(word);
    letter_ = word.empty() ? '?' : static_cast<char>(std::tolower(static_cast<unsigned char>(word[0])));
    if (word.size() == 1 && isWordCode(letter_)) {
        out_.code.id = word_code(letter_);
        return {};
    }
    const auto number = word.empty() ? std::nullopt : parse_double(word.substr(1));
    const bool is_code = (letter_ == 'g' || letter_ == 'm') && number && *number >= 0.0;
    if (!is_code) {
        return error("a code such as M400, G88.1, T, S or F must come first", offset_of(word));
    }
    const double scaled = *number * (letter_ == 'g' ? 10.0 : 1.0);
    const int whole = static_cast<int>(std::lround(scaled));
    if (std::fabs(scaled - whole) > 1e-6 || whole >= 1000) {
        return error("the number must be below 1000 for M, below 100 and with one decimal for G",
                     offset_of(word));
    }
    const GCode code = out_.code.id = make_code(letter_, whole);
    const bool allowed = find_code(code) == nullptr || code >= M(100) ||
                         std::ranges::find(REMAPPABLE, code) != std::end(REMAPPABLE);
    if (!allowed) {
        out_.refusal = fmt::format("{}: REMAP={}: {} cannot be remapped; the line has no effect",
                                   line_.place.str(), line_.text, out_.name);
    }
    return {};
}

Result<> Reader::read_argspec(std::string_view text, std::size_t offset) {
    out_.argspec = text;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const char lower = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        if (c == '@') {
            out_.positional = true;
        } else if (c == '^') {
            out_.needs_speed = true;
        } else if (c == '>') {
            out_.needs_feed = true;
        } else if (lower == 'n') {
            out_.wants_line = true;
        } else if (lower >= 'a' && lower <= 'z' && lower != 'g' && lower != 'm' && lower != 'o') {
            const auto same = [lower](const RemapWord &word) { return word.letter == lower; };
            if (std::ranges::any_of(out_.words, same)) {
                return error(fmt::format("argspec names the word {} twice", c), offset + i);
            }
            out_.words.push_back({lower, c != lower});
        } else {
            return error(fmt::format("'{}' is not allowed in an argspec", c), offset + i,
                         "use letters of words (upper case: required), @, ^, > and n");
        }
    }
    return {};
}

Result<> Reader::set_group(int number, std::size_t offset) {
    for (const GroupNumber &row : GROUPS) {
        if (row.letter == letter_ && row.number == number) {
            out_.code.group = row.group;
            out_.modal_group = number;
            has_group_ = true;
            return {};
        }
    }
    return error(fmt::format("{} cannot be in modal group {}", out_.name, number), offset,
                 letter_ == 'g' ? "G codes are in group 1" : "M codes are in groups 4 to 10");
}

Result<> Reader::read_group(std::string_view text, std::size_t offset) {
    const auto number = parse_int(text);
    if (!number || *number < 0 || *number > 99) {
        return error(fmt::format("modalgroup needs a number, not '{}'", text), offset);
    }
    if (isWordCode(letter_)) {
        return {};  // T, S and F have their own phase
    }
    return set_group(static_cast<int>(*number), offset);
}

Result<> Reader::read_option(std::string_view word) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string key = to_lower(word.substr(0, equals));
    const std::string_view value = equals < word.size() ? word.substr(equals + 1) : std::string_view();
    const std::size_t offset = offset_of(word) + equals + 1;
    if (key == "modalgroup") {
        return read_group(value, offset);
    }
    if (key == "argspec") {
        return read_argspec(value, offset);
    }
    std::string *const target = key == "ngc"                     ? &out_.ngc
                                : key == "py" || key == "python" ? &out_.function
                                : key == "prolog"                ? &out_.prolog
                                : key == "epilog"                ? &out_.epilog
                                                                 : nullptr;
    if (target == nullptr) {
        return error(fmt::format("unknown option '{}'", word), offset_of(word),
                     "options are modalgroup=, argspec=, ngc=, py=, python=, prolog=, epilog=");
    }
    if (value.empty()) {
        return error(fmt::format("{}= needs a name", key), offset_of(word));
    }
    *target = key == "ngc" ? to_lower(value) : std::string(value);
    return {};
}

Result<> Reader::finish() {
    if (out_.ngc.empty() == out_.function.empty()) {
        return error(out_.ngc.empty() ? "ngc=NAME or py=NAME is missing"
                                      : "either ngc= or py= is possible, not both",
                     0);
    }
    const Code *existing = find_code(out_.code.id);
    if (!has_group_ && existing != nullptr) {
        out_.code.group = existing->group;
    } else if (!has_group_) {
        if (auto done = set_group(letter_ == 'g' ? DEFAULT_G_GROUP : DEFAULT_M_GROUP, 0); !done) {
            return done;
        }
    }
    // A script reads the words of its block itself, so any word is permitted, but axis words only with a G
    // code.
    out_.code.words = (bit_of(LETTER_COUNT) - 1) & ~AXES;
    out_.code.usesAxes = letter_ == 'g';
    return {};
}

Result<Remap> Reader::read() {
    out_.place = line_.place;
    if (Result<> done = read_code(next_word()); !done) {
        return std::unexpected(done.error());
    }
    for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
        if (Result<> done = read_option(word); !done) {
            return std::unexpected(done.error());
        }
    }
    if (Result<> done = finish(); !done) {
        return std::unexpected(done.error());
    }
    return std::move(out_);
}

}  // namespace

ScriptRemap Remap::described() const {
    return {name, argspec,  prolog,      epilog,
            ngc,  function, modal_group, letter_of(code.id) == 'g' ? number_of(code.id) : -1};
}

Result<Remap> parse_remap(const RemapLine &line) {
    return Reader(line).read();
}

// ------------------------------------------------------------------------------- while programs run

Result<> Remaps::load(std::span<const RemapLine> lines) {
    all_.clear();
    refused_.clear();
    for (const RemapLine &line : lines) {
        Result<Remap> made = parse_remap(line);
        if (!made) {
            return std::unexpected(made.error());
        }
        if (!made->refusal.empty()) {
            refused_.push_back(std::move(made->refusal));
            continue;
        }
        for (const Remap &other : all_) {
            if (other.code.id == made->code.id) {
                return fail(fmt::format("REMAP={}: {} is remapped twice", line.text, made->name), line.place);
            }
        }
        all_.push_back(std::move(*made));
    }
    for (Remap &remap : all_) {
        remap.code.remap = &remap;
    }
    return {};
}

bool Remaps::isRunning(const Remap &remap) const {
    return std::ranges::any_of(running_,
                               [&remap](const Running &running) { return running.remap == &remap; });
}

const Code *Remaps::find(GCode code) const {
    for (const Remap &remap : all_) {
        if (remap.code.id == code && !isRunning(remap)) {
            return &remap.code;
        }
    }
    return nullptr;
}

void Remaps::end_above(std::size_t level) {
    while (!running_.empty() && running_.back().level > level) {
        running_.pop_back();
    }
}

void Remaps::count_builtin(GCode code) {
    for (Running &running : running_) {
        if (running.remap->code.id == code) {
            ++running.builtins;
        }
    }
}

std::string Remaps::recursion_text(GCode code) const {
    for (const Running &running : running_) {
        const Remap &remap = *running.remap;
        if (remap.code.id == code) {
            return fmt::format("{} is used in its own remap procedure, but has no built-in meaning",
                               remap.name);
        }
    }
    return {};
}

PendingBlock Remaps::take_interrupted() {
    PendingBlock out = std::move(*interrupted_);
    interrupted_.reset();
    return out;
}

std::string missing_words(const PendingBlock &block, const State &state) {
    std::string missing;
    const auto add = [&missing](std::string_view what) {
        missing += missing.empty() ? "" : ",";
        missing += what;
    };
    for (const RemapWord &word : block.remap->words) {
        if (word.required && !block.values.has(word.letter)) {
            const char upper = static_cast<char>(std::toupper(word.letter));
            add({&upper, 1});
        }
    }
    if (block.remap->needs_feed && state.feed <= 0.0) {
        add("F>0");
    }
    if (block.remap->needs_speed && state.spindles[0].speed <= 0.0) {
        add("S>0");
    }
    return missing;
}

void pass_words(const PendingBlock &block, bool count_named, Parameters &parameters, Names &names) {
    const Remap &remap = *block.remap;
    for (int i = 1; i <= ARGUMENT_COUNT; ++i) {
        parameters.set(i, 0.0);
    }
    int position = 0;
    for (const RemapWord &word : remap.words) {
        if (!block.values.has(word.letter)) {
            continue;
        }
        const double value = block.values.at(word.letter);
        if (remap.positional) {
            parameters.set(++position, value);
        } else {
            parameters.set_named(names.intern(std::string(1, word.letter)), false, value);
        }
    }
    if (remap.wants_line) {
        parameters.set_named(names.intern("n"), false, block.line);
    }
    if (count_named && remap.positional) {
        parameters.set_named(names.intern("n_args"), false, position);
    }
    parameters.commit();
}

}  // namespace mw::gcode::detail
