// SPDX-License-Identifier: GPL-2.0-or-later
#include <algorithm>
#include <cstdlib>
#include <optional>

#include "base/ini/ini_file.hh"
#include "base/ini/ini_programs.hh"
#include "base/text.hh"

namespace mw::ini {
namespace {

struct Query {
    std::string file, section, variable;
    bool has_section = false, home_expanded = false;
    std::int64_t number = 1;
};

std::string with_home(const std::string &value) {
    const char *home = std::getenv("HOME");
    const bool of_home = value == "~" || value.substr(0, 2) == "~/";
    return of_home && home != nullptr ? home + value.substr(1) : value;
}

/// The N-th entry of that name in its section, or in all sections.
const IniEntry *look_up(const IniFile &file, const Query &query) {
    std::int64_t left = std::max<std::int64_t>(1, query.number);
    for (const IniEntry &entry : file.entries()) {
        const bool wanted =
            entry.key == query.variable && (!query.has_section || entry.section == query.section);
        if (wanted && --left == 0) {
            return &entry;
        }
    }
    return nullptr;
}

constexpr const char *INIVAR_USAGE =
    "inivar: -var <variable> {-tildeexpand} {-sec <section>} {-ini <INI file>} "
    "[-num <nth item>]\n";

/// Fills the query from the words; returns a message when they are not valid.
std::optional<std::string> read_inivar(const std::vector<std::string> &words, Query &query) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string &word = words[i];
        if (word == "-tildeexpand") {
            query.home_expanded = true;
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
            query.has_section = true;
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

}  // namespace

ProgramOutput run_inivar(const std::vector<std::string> &words) {
    Query query;
    query.file = "emc.ini";
    if (const auto problem = read_inivar(words, query)) {
        return {1, "", *problem};
    }
    diagnostics::Sink ignored;  // other errors in the file are reported when the machine starts
    const auto file = IniFile::load(query.file, ignored);
    if (!file) {
        return {255, "", "inivar: can't open " + query.file + "\n"};
    }
    const IniEntry *entry = look_up(*file, query);
    if (entry == nullptr && file->early_key().has_value()) {
        const IniEntry &early = *file->early_key();
        return {1, "",
                early.place.file + ':' + std::to_string(early.place.line) + ": error: Tag '" + early.key +
                    "' found without prior section definition\n"};
    }
    if (entry == nullptr) {
        return {1, "",
                "Can not find -sec " + (query.has_section ? query.section : "(null)") + " -var " +
                    query.variable + " -num " + std::to_string(std::max<std::int64_t>(1, query.number)) +
                    " \n"};
    }
    return {0, (query.home_expanded ? with_home(entry->value) : entry->value) + "\n", ""};
}

}  // namespace mw::ini
