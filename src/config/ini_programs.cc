// SPDX-License-Identifier: GPL-2.0-or-later
#include "config/ini_programs.hh"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "base/text.hh"
#include "config/ini_file.hh"
#include "config/ini_value.hh"

namespace mw::config {
namespace {

struct Query {
    std::string file, section, variable;
    bool hasSection = false, isHomeExpanded = false;
    std::int64_t number = 1;
};

std::string with_home(const std::string &value) {
    const char *home = std::getenv("HOME");
    const bool isOfHome = value == "~" || value.substr(0, 2) == "~/";
    return isOfHome && home != nullptr ? home + value.substr(1) : value;
}

/// The N-th entry of that name in its section, or in any.
const IniEntry *look_up(const IniFile &file, const Query &query, bool isEmptyCounted) {
    std::int64_t left = std::max<std::int64_t>(1, query.number);
    for (const IniEntry &entry : file.entries()) {
        const bool isWanted = entry.key == query.variable &&
                              (!query.hasSection || entry.section == query.section) &&
                              (isEmptyCounted || !entry.value.empty());
        if (isWanted && --left == 0) {
            return &entry;
        }
    }
    return nullptr;
}

// ---- inivar

constexpr const char *INIVAR_USAGE =
    "inivar: -var <variable> {-tildeexpand} {-sec <section>} {-ini <INI file>} "
    "[-num <nth item>]\n";

/// Fills the query from the words; a message when they are wrong.
std::optional<std::string> read_inivar(const std::vector<std::string> &words, Query &query) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string &word = words[i];
        if (word == "-tildeexpand") {
            query.isHomeExpanded = true;
            continue;
        }
        const std::string missing = word == "-var"   ? "variable name"
                                    : word == "-sec" ? "section name"
                                    : word == "-ini" ? "INI file"
                                    : word == "-num" ? "line"
                                                     : "";
        if (missing.empty()) {
            return INIVAR_USAGE;
        }
        if (++i == words.size()) {
            return "inivar: " + missing + " not specified after " + word + "\n";
        }
        const std::string &value = words[i];
        if (word == "-var") {
            query.variable = value;
        } else if (word == "-ini") {
            query.file = value;
        } else if (word == "-sec") {
            query.section = value;
            query.hasSection = true;
        } else if (const auto number = parse_int(value); number.has_value()) {
            query.number = *number;
        } else {
            return "inivar: invalid number after -num\n";
        }
    }
    if (query.variable.empty()) {
        return "inivar: no variable supplied\n";
    }
    return std::nullopt;
}

// ---- inivalue

constexpr const char *INIVALUE_USAGE =
    "usage: inivalue [OPTIONS] --var=NAME FILE\n"
    "\n"
    "  --var=NAME        the variable to look for\n"
    "  --sec=SECTION     its section (default: any)\n"
    "  --num=N           its N-th value, from 1 (default: 1)\n"
    "  --type=TYPE       print it as bool (TRUE or FALSE), sint, uint, real or string (default: string);\n"
    "                    a value that is none is an error\n"
    "  --default=VALUE   print this when there is no such variable\n"
    "  --tildeexpand     a leading ~/ is the home folder\n"
    "  --help            this text\n"
    "\n"
    "A # or ; inside of a value belongs to it. Exit status: 0 printed, 1 not found or of another type, 2 "
    "wrong\n"
    "usage or no such file.\n";

struct ValueQuery : Query {
    std::string type = "string";
    std::optional<std::string> preset;
    bool isHelp = false;
};

bool takes(const std::string &word, std::string_view option, std::string &value) {
    if (word.size() <= option.size() || word.compare(0, option.size(), option) != 0 ||
        word[option.size()] != '=') {
        return false;
    }
    value = word.substr(option.size() + 1);
    return true;
}

/// One option or the file; a message when it is wrong.
std::optional<std::string> read_inivalue_word(const std::string &word, ValueQuery &query) {
    std::string value;
    if (word == "--help") {
        query.isHelp = true;
    } else if (word == "--tildeexpand") {
        query.isHomeExpanded = true;
    } else if (takes(word, "--var", query.variable) || takes(word, "--type", query.type)) {
        return std::nullopt;
    } else if (takes(word, "--sec", query.section)) {
        query.hasSection = true;
    } else if (takes(word, "--default", value)) {
        query.preset = value;
    } else if (takes(word, "--num", value)) {
        const auto number = parse_int(value);
        if (!number.has_value() || *number < 1) {
            return "--num needs a number from 1, not '" + value + "'";
        }
        query.number = *number;
    } else if (word.substr(0, 1) == "-") {
        return "unknown option '" + word + "'";
    } else if (!query.file.empty()) {
        return "one file only, not '" + query.file + "' and '" + word + "'";
    } else {
        query.file = word;
    }
    return std::nullopt;
}

std::optional<std::string> read_inivalue(const std::vector<std::string> &words, ValueQuery &query) {
    for (const std::string &word : words) {
        if (auto problem = read_inivalue_word(word, query)) {
            return problem;
        }
    }
    constexpr const char *TYPES[] = {"bool", "sint", "uint", "real", "string"};
    if (std::none_of(std::begin(TYPES), std::end(TYPES), [&](const char *t) { return query.type == t; })) {
        return "--type is bool, sint, uint, real or string, not '" + query.type + "'";
    }
    if (!query.isHelp && query.variable.empty()) {
        return "--var is missing";
    }
    return !query.isHelp && query.file.empty() ? std::optional<std::string>("the file is missing")
                                               : std::nullopt;
}

/// The value as its type is printed; nothing when it is of another type.
std::optional<std::string> typed(const std::string &value, const std::string &type) {
    if (type == "bool") {
        const auto truth = ini_bool(value);
        return truth ? std::optional<std::string>(*truth ? "TRUE" : "FALSE") : std::nullopt;
    }
    if (type == "sint") {
        const auto number = parse_int(value);
        return number ? std::optional(std::to_string(*number)) : std::nullopt;
    }
    if (type == "uint") {
        const auto number = parse_uint(value);
        return number ? std::optional(std::to_string(*number)) : std::nullopt;
    }
    if (type == "real") {
        const auto number = parse_double(value);
        return number ? std::optional(to_text(*number)) : std::nullopt;
    }
    return value;
}

}  // namespace

ProgramOutput run_inivar(const std::vector<std::string> &words) {
    Query query;
    query.file = "emc.ini";
    if (const auto problem = read_inivar(words, query)) {
        return {1, "", *problem};
    }
    diag::Sink ignored;  // what else is wrong with the file is told by those who run it
    const auto file = IniFile::load(query.file, ignored);
    if (!file) {
        return {255, "", "inivar: can't open " + query.file + "\n"};
    }
    const IniEntry *entry = look_up(*file, query, false);
    if (entry == nullptr && file->early_key().has_value()) {
        const IniEntry &early = *file->early_key();
        return {1, "",
                early.place.file + ':' + std::to_string(early.place.line) + ": error: Tag '" + early.key +
                    "' found without prior section definition\n"};
    }
    if (entry == nullptr) {
        return {1, "",
                "Can not find -sec " + (query.hasSection ? query.section : "(null)") + " -var " +
                    query.variable + " -num " + std::to_string(std::max<std::int64_t>(1, query.number)) +
                    " \n"};
    }
    return {0, (query.isHomeExpanded ? with_home(entry->value) : entry->value) + "\n", ""};
}

ProgramOutput run_inivalue(const std::vector<std::string> &words) {
    ValueQuery query;
    if (const auto problem = read_inivalue(words, query)) {
        return {2, "", "inivalue: " + *problem + "; see inivalue --help\n"};
    }
    if (query.isHelp) {
        return {0, INIVALUE_USAGE, ""};
    }
    diag::Sink ignored;
    const auto file = IniFile::load(query.file, ignored);
    if (!file) {
        return {2, "", "inivalue: " + file.error().str() + "\n"};
    }
    const IniEntry *entry = look_up(*file, query, true);
    if (entry == nullptr && !query.preset) {
        return {1, "",
                "inivalue: " + query.file + ": there is no [" + (query.hasSection ? query.section : "*") +
                    "]" + query.variable +
                    (query.number > 1 ? " with number " + std::to_string(query.number) : std::string()) +
                    "\n"};
    }
    const std::string value = entry != nullptr ? entry->value : *query.preset;
    const auto text = typed(query.isHomeExpanded ? with_home(value) : value, query.type);
    if (!text) {
        return {1, "",
                "inivalue: " + (entry != nullptr ? entry->place.str() + ": " : std::string()) + "'" + value +
                    "' is no " + query.type + "\n"};
    }
    return {0, *text + "\n", ""};
}

}  // namespace mw::config
