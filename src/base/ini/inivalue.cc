// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "base/ini/ini_escape.hh"
#include "base/ini/ini_file.hh"
#include "base/ini/ini_programs.hh"
#include "base/ini/ini_script.hh"
#include "base/text.hh"

namespace mw::ini {
namespace {

constexpr const char *USAGE =
    "usage: inivalue [OPTIONS] --var=NAME FILE\n"
    "       inivalue --sections FILE\n"
    "       inivalue --variables [--content] [--sec=SECTION] FILE\n"
    "\n"
    "  --var=NAME        the variable to look for\n"
    "  --sec=SECTION     its section (default: any)\n"
    "  --num=N           its N-th value, from 1 (default: 1)\n"
    "  --all             all values from the N-th on, one a line\n"
    "  --type=TYPE       print it as b(ool), i(nt), u(int), r(eal) or s(tring, the default)\n"
    "  -m LOW, -M HIGH   the lowest and highest number allowed\n"
    "  -b, -B            print bool as 1 and 0, or as True and False, instead of true and false\n"
    "  --default=VALUE   print this when there is no such variable\n"
    "  --tildeexpand     a leading ~/ is the home folder\n"
    "  --sections        print the names of all sections\n"
    "  --variables       print the names of all variables\n"
    "  --content         with their values, as NAME=VALUE\n"
    "  --help            this text\n"
    "\n"
    "A value for an option may also be the next word. A # or ; inside of a value belongs to it. Errors in "
    "the\nfile are printed as FILE:LINE: error: ... Exit status: 0 printed, 1 not found, not of the type or "
    "out\nof its range, or an error in the file, 2 wrong usage.\n";

struct Query {
    std::string file, section, variable;
    bool has_section = false, home_expanded = false, all = false, is_help = false;
    bool is_sections = false, is_variables = false, has_content = false;
    std::int64_t number = 1;
    char type = 's';   ///< type letter of --type
    char truth = 't';  ///< 't' true, 'b' 1, 'B' True
    std::optional<std::string> preset, lowest, highest;

    std::string label() const { return fmt::format("[{}]{}", section, variable); }
};

// ---- the options

bool read_flag(const std::string &word, Query &query) {
    bool *const flag = word == "--help"          ? &query.is_help
                       : word == "--tildeexpand" ? &query.home_expanded
                       : word == "--all"         ? &query.all
                       : word == "--sections"    ? &query.is_sections
                       : word == "--variables"   ? &query.is_variables
                       : word == "--content"     ? &query.has_content
                                                 : nullptr;
    if (flag != nullptr) {
        *flag = true;
    } else if (word == "-b" || word == "-B") {
        query.truth = word[1];
    }
    return flag != nullptr || word == "-b" || word == "-B";
}

std::optional<std::string> read_type(const std::string &value, Query &query) {
    constexpr const char *TYPES[] = {"b",    "bool", "i",    "int", "sint",  "u",
                                     "uint", "r",    "real", "s",   "string"};
    if (std::none_of(std::begin(TYPES), std::end(TYPES), [&](const char *t) { return value == t; })) {
        return "--type is b, i, u, r or s, not '" + value + "'";
    }
    query.type = value == "sint" ? 'i' : value[0];
    return std::nullopt;
}

/// Reads an option with its value; returns a message when it is not valid.
std::optional<std::string> read_option(const std::string &name, const std::string &value, Query &query) {
    if (name == "--var") {
        query.variable = value;
    } else if (name == "--sec") {
        query.section = value;
        query.has_section = true;
    } else if (name == "--default") {
        query.preset = value;
    } else if (name == "-m") {
        query.lowest = value;
    } else if (name == "-M") {
        query.highest = value;
    } else if (name == "--type") {
        return read_type(value, query);
    } else {
        const auto number = parse_int(value);
        if (!number || *number < 1) {
            return "--num needs a number from 1, not '" + value + "'";
        }
        query.number = *number;
    }
    return std::nullopt;
}

bool hasValue(const std::string &name) {
    constexpr const char *NAMES[] = {"--var", "--sec", "--num", "--type", "--default", "-m", "-M"};
    return std::any_of(std::begin(NAMES), std::end(NAMES), [&](const char *n) { return name == n; });
}

std::optional<std::string> read_words(const std::vector<std::string> &words, Query &query) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string &word = words[i];
        const auto equals = word.starts_with("--") ? word.find('=') : std::string::npos;
        const std::string name = word.substr(0, equals);
        if (read_flag(word, query)) {
            continue;
        }
        if (hasValue(name)) {
            const bool is_next = equals == std::string::npos;
            if (is_next && ++i == words.size()) {
                return name + " needs a value";
            }
            if (auto problem = read_option(name, is_next ? words[i] : word.substr(equals + 1), query)) {
                return problem;
            }
        } else if (word.starts_with("-")) {
            return "unknown option '" + word + "'";
        } else if (!query.file.empty()) {
            return "one file only, not '" + query.file + "' and '" + word + "'";
        } else {
            query.file = word;
        }
    }
    if (query.is_help) {
        return std::nullopt;
    }
    if (query.variable.empty() && !query.is_sections && !query.is_variables) {
        return "--var is missing";
    }
    return query.file.empty() ? std::optional<std::string>("the file is missing") : std::nullopt;
}

// ---- the values

/// The range from -m and -M; nothing, with a message, when a limit is not a number or the limits cross.
template <class T, class Read>
std::optional<std::pair<T, T>> range_of(const Query &query, const char *type, Read read,
                                        std::string &messages) {
    T limits[2] = {std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max()};
    const std::optional<std::string> *const texts[2] = {&query.lowest, &query.highest};
    for (int i = 0; i < 2; ++i) {
        if (!texts[i]->has_value()) {
            continue;
        }
        std::string ignored;  // negative limits of an unsigned value wrap without a warning
        const auto limit = read({"", i == 0 ? "-m" : "-M", **texts[i], {}}, ignored);
        if (!limit) {
            messages +=
                fmt::format("error: '{}' after {} is no {}\n", **texts[i], i == 0 ? "-m" : "-M", type);
            return std::nullopt;
        }
        limits[i] = *limit;
    }
    if (limits[0] > limits[1]) {
        messages += fmt::format("error: Invalid {} range min '{}' > max '{}'\n", type, limits[0], limits[1]);
        return std::nullopt;
    }
    return std::pair(limits[0], limits[1]);
}

std::string shown(double limit) {
    return fmt::format("{:g}", limit);
}
template <class T>
std::string shown(T limit) {
    return std::to_string(limit);
}

/// A number as text; nothing, with a message, when it is missing or out of range.
template <class T, class Read>
std::optional<std::string> number(const Query &query, const IniEntry &entry, const char *type, Read read,
                                  std::string &messages) {
    const auto range = range_of<T>(query, type, read, messages);
    if (!range) {
        return std::nullopt;
    }
    const std::optional<T> value = read(entry, messages);
    if (!value || *value < range->first || *value > range->second) {
        messages += fmt::format("error: Invalid {} {}='{}' or out of range [{},{}]\n", type, query.label(),
                                entry.value, shown(range->first), shown(range->second));
        return std::nullopt;
    }
    if constexpr (std::is_same_v<T, double>) {
        return fmt::format("{:.15e}", *value);
    } else {
        return std::to_string(*value);
    }
}

std::optional<std::string> text_of(const Query &query, const IniEntry &entry, std::string &messages) {
    if (!query.home_expanded || (entry.value != "~" && !entry.value.starts_with("~/"))) {
        return entry.value;
    }
    const char *home = std::getenv("HOME");
    if (home == nullptr) {
        messages += fmt::format("error: Tilde expansion failed on '{}'\n", entry.value);
        return std::nullopt;
    }
    return home + entry.value.substr(1);
}

std::optional<std::string> truth_of(const Query &query, const IniEntry &entry, std::string &messages) {
    const auto truth = script_bool(entry, messages);
    if (!truth) {
        return std::nullopt;
    }
    return query.truth == 'b'   ? (*truth ? "1" : "0")
           : query.truth == 'B' ? (*truth ? "True" : "False")
                                : (*truth ? "true" : "false");
}

std::optional<std::string> typed(const Query &query, const IniEntry &entry, std::string &messages) {
    switch (query.type) {
    case 'b': return truth_of(query, entry, messages);
    case 'i': return number<std::int64_t>(query, entry, "integer", script_signed, messages);
    case 'u': return number<std::uint64_t>(query, entry, "unsigned", script_unsigned, messages);
    case 'r': return number<double>(query, entry, "real", script_real, messages);
    default: return text_of(query, entry, messages);
    }
}

// ---- the queries

void list_sections(const IniFile &file, ProgramOutput &result) {
    for (const std::string &name : file.sections()) {
        result.out += name + '\n';
    }
}

void list_variables(const Query &query, const IniFile &file, ProgramOutput &result) {
    if (query.has_section && !file.hasSection(query.section)) {
        result.status = 1;
        result.err += fmt::format("error: Cannot find section '{}' in '{}'\n", query.section, query.file);
    }
    for (const IniEntry &entry : file.entries()) {
        if (!query.has_section || entry.section == query.section) {
            result.out +=
                entry.key + (query.has_content ? '=' + encode_ini_value(entry.value) : std::string()) + '\n';
        }
    }
}

void print_values(const Query &query, const IniFile &file, ProgramOutput &result) {
    std::vector<IniEntry> found;
    std::int64_t number = 0;
    for (const IniEntry &entry : file.entries()) {
        const bool wanted =
            entry.key == query.variable && (!query.has_section || entry.section == query.section);
        if (wanted && ++number >= query.number && (query.all || found.empty())) {
            found.push_back(entry);
        }
    }
    if (found.empty() && query.preset) {
        found.push_back({query.section, query.variable, *query.preset, {"--default", 0, 0}});
    }
    if (found.empty()) {
        result.status = 1;
        result.err +=
            query.all ? fmt::format("error: No instance {} or more of '{}'\n", query.number, query.label())
                      : fmt::format("error: Cannot find instance {} of '{}'\n", query.number, query.label());
    }
    for (const IniEntry &entry : found) {
        const auto text = typed(query, entry, result.err);
        if (!text) {
            result.status = 1;
            return;
        }
        result.out += *text + '\n';
    }
}

}  // namespace

ProgramOutput run_inivalue(const std::vector<std::string> &words) {
    Query query;
    if (const auto problem = read_words(words, query)) {
        return {2, "", "inivalue: " + *problem + "; see inivalue --help\n"};
    }
    if (query.is_help) {
        return {0, USAGE, ""};
    }
    diagnostics::Sink sink;
    const auto file = IniFile::load(query.file, sink, IniSyntax::STRICT);
    if (!file) {
        return {1, "", query.file + ": error: " + file.error().message + '\n'};
    }
    ProgramOutput result;
    for (const diagnostics::Diagnostic &one : sink.all()) {
        result.err += script_place(one.what.place) +
                      (one.severity == diagnostics::Severity::ERROR ? "error: " : "warning: ") +
                      one.what.message + '\n';
    }
    if (sink.hasErrors()) {
        result.status = 1;
    } else if (query.is_sections) {
        list_sections(*file, result);
    } else if (query.is_variables) {
        list_variables(query, *file, result);
    } else {
        print_values(query, *file, result);
    }
    return result;
}

}  // namespace mw::ini
