// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/confinement_config.hh"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/text.hh"

namespace mw::machine {
namespace {

constexpr std::string_view BLANKS = " \t";

void add_list(std::string_view list, std::vector<std::string> &extensions) {
    for (std::size_t at = list.find('.'); at != std::string_view::npos; at = list.find('.', at)) {
        const std::size_t end = std::min(list.find_first_of(", \t", at), list.size());
        extensions.push_back(to_lower(list.substr(at, end - at)));
        at = end;
    }
}

/// [DISPLAY]PROGRAM_PREFIX, separated by colons; the default is the folder of the INI file.
std::vector<std::string> program_folders(const ini::IniFile &ini) {
    const ini::IniEntry *entry = ini.find("DISPLAY", "PROGRAM_PREFIX");
    std::string_view rest = entry == nullptr ? std::string_view(".") : std::string_view(entry->value);
    std::vector<std::string> folders;
    while (!rest.empty()) {
        const std::size_t colon = std::min(rest.find(':'), rest.size());
        if (const std::string_view one = trim(rest.substr(0, colon)); !one.empty()) {
            folders.push_back(ini.resolve_path(one));
        }
        rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
    return folders;
}

}  // namespace

std::vector<std::string> program_extensions(const ini::IniFile &ini) {
    std::vector<std::string> extensions{".ngc", ".nc", ".tap", ".cnc", ".gcode"};
    for (const ini::IniEntry &entry : ini.entries()) {
        if (entry.section == "FILTER" && entry.key == "PROGRAM_EXTENSION") {
            add_list(entry.value, extensions);
        } else if (entry.section == "FILTER") {
            extensions.push_back('.' + to_lower(entry.key));
        }
    }
    return extensions;
}

task::Confinement read_confinement(const ini::IniFile &ini, const std::string &parameter_file) {
    task::Confinement confinement;
    confinement.program_folders = program_folders(ini);
    confinement.program_extensions = program_extensions(ini);
    std::vector<std::string> &kept = confinement.kept_files;
    kept = {ini.path(), parameter_file};
    for (const ini::IniEntry &entry : ini.entries()) {
        const std::string_view value = entry.value;
        const std::string_view word = value.substr(0, value.find_first_of(BLANKS));
        std::error_code ignored;
        for (const std::string &named : {ini.resolve_path(value), ini.resolve_path(word)}) {
            if (std::filesystem::is_regular_file(named, ignored)) {
                kept.push_back(named);
            }
        }
        kept.push_back(entry.place.file);
    }
    std::ranges::sort(kept);
    const auto twice = std::ranges::unique(kept);
    kept.erase(twice.begin(), twice.end());
    return confinement;
}

}  // namespace mw::machine
