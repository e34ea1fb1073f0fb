// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/named_files.hh"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string_view>

#include "base/find_program.hh"
#include "base/text.hh"
#include "hal/core/command_hints.hh"
#include "hal/script/session.hh"

namespace mw::doctor {
namespace {

namespace fs = std::filesystem;
using ini::IniEntry;
using ini::IniFile;

bool isThere(const std::string &path) {
    std::error_code error;
    return fs::exists(path, error);
}

bool isFolder(const std::string &path) {
    std::error_code error;
    return fs::is_directory(path, error);
}

std::string label(const IniEntry &entry) {
    return '[' + entry.section + ']' + entry.key;
}

/// The value without a comment.
std::string first_word(const IniEntry &entry) {
    const std::vector<std::string> words = split_words(entry.value);
    return words.empty() ? std::string() : words[0];
}

/// A key whose value is one file or folder, relative to the INI file.
struct Named {
    const char *section, *key;
    const char *consequence;
};
constexpr std::array FILES = {
    Named{"DISPLAY", "OPEN_FILE", "no program is open at the start"},
    Named{"DISPLAY", "INTRO_GRAPHIC", "it is not shown"},
    Named{"DISPLAY", "PYVCP", "the display has no such panel"},
    Named{"PYTHON", "TOPLEVEL", "remaps in Python fail"},
};
constexpr std::array FOLDERS = {
    Named{"DISPLAY", "PROGRAM_PREFIX", "programs and subroutines are not found there"},
    Named{"RS274NGC", "SUBROUTINE_PATH", "subroutines are not found there"},
    Named{"RS274NGC", "USER_M_PATH", "M100 to M199 are not found there"},
    Named{"PYTHON", "PATH_PREPEND", "modules are not found there"},
    Named{"PYTHON", "PATH_APPEND", "modules are not found there"},
};

void examine_file(const IniFile &ini, const Named &named, diagnostics::Sink &sink) {
    const IniEntry *const entry = ini.find(named.section, named.key);
    const std::string name = entry == nullptr ? "" : first_word(*entry);

    if (!name.empty() && name != "\"\"" && name != "''" && !isThere(ini.resolve_path(name))) {
        sink.warning(label(*entry) + ": there is no file '" + ini.resolve_path(name) +
                         "': " + named.consequence,
                     entry->place);
    }
}

void examine_folders(const IniFile &ini, const Named &named, diagnostics::Sink &sink) {
    for (const IniEntry *entry : ini.find_all(named.section, named.key)) {
        std::istringstream folders(first_word(*entry));
        std::string folder;
        while (std::getline(folders, folder, ':')) {
            if (!folder.empty() && !isFolder(ini.resolve_path(folder))) {
                sink.warning(label(*entry) + ": there is no folder '" + ini.resolve_path(folder) +
                                 "': " + named.consequence,
                             entry->place);
            }
        }
    }
}

/// True for a file in the search folders of HAL files.
bool isHalFile(const IniFile &ini, const std::string &name) {
    const std::string_view plain = name.starts_with("LIB:") ? std::string_view(name).substr(4) : name;
    if (!name.starts_with("LIB:") && isThere(ini.resolve_path(name))) {
        return true;
    }
    return std::ranges::any_of(hal::script::default_library(), [&plain](const std::string &folder) {
        return isThere(folder + '/' + std::string(plain));
    });
}

void examine_hal_names(const IniFile &ini, diagnostics::Sink &sink) {
    for (const char *key : {"POSTGUI_HALFILE", "SHUTDOWN"}) {
        for (const IniEntry *entry : ini.find_all("HAL", key)) {
            const std::string name = first_word(*entry);
            if (!name.empty() && !isHalFile(ini, name)) {
                sink.warning(label(*entry) + ": HAL file '" + name + "' is not found", entry->place,
                             "searched in the folder of the INI file and in the library of HAL files");
            }
        }
    }
}

/// Files of parameters and tools must be writable.
void examine_writing(const std::string &path, const IniEntry *entry, diagnostics::Sink &sink) {
    if (path.empty() || entry == nullptr) {
        return;
    }
    std::error_code error;
    const fs::path folder = fs::absolute(path, error).parent_path();
    if (!isFolder(folder.string())) {
        sink.error(label(*entry) + ": there is no folder '" + folder.string() + '\'', entry->place);
    } else if (::access(folder.c_str(), W_OK) != 0) {
        // Files are replaced, not overwritten.
        sink.error(label(*entry) + ": this user cannot write to '" + folder.string() +
                       "': changes are lost at the end of the machine",
                   entry->place, "copy the configuration to a folder of your own");
    } else if (isThere(path) && ::access(path.c_str(), R_OK) != 0) {
        sink.error(label(*entry) + ": this user cannot read '" + path + '\'', entry->place);
    }
}

std::string folder_of(const IniFile &ini) {
    std::error_code error;
    return fs::absolute(ini.folder(), error).string();
}

/// Names that the launcher handles itself.
bool isOwnDisplay(const std::string &name) {
    const bool is_tk = name == "tklinuxcnc" || name == "tkemc";
    return name == "millwright" || name == "dummy" || (is_tk && std::getenv("LINUXCNC_TCL_DIR") != nullptr);
}

void examine_programs(const IniFile &ini, diagnostics::Sink &sink) {
    const IniEntry *const display = ini.find("DISPLAY", "DISPLAY");
    const std::string screen = display == nullptr ? "" : first_word(*display);
    if (!screen.empty() && !isOwnDisplay(screen) && find_program(screen, folder_of(ini)).empty()) {
        sink.warning("[DISPLAY]DISPLAY: there is no program '" + screen +
                         "': the machine starts only with `start --no-display`",
                     display->place, hal::hint_for_absent(screen));
    }
    for (const IniEntry *entry : ini.find_all("APPLICATIONS", "APP")) {
        const std::string name = first_word(*entry);
        if (!name.empty() && find_program(name, folder_of(ini)).empty()) {
            sink.warning("[APPLICATIONS]APP: there is no program '" + name + '\'', entry->place,
                         hal::hint_for_absent(name));
        }
    }
    for (const IniEntry &entry : ini.entries()) {
        const bool is_filter =
            entry.section == "FILTER" && entry.key != "PROGRAM_EXTENSION" && entry.key != "FILTER_PROGRESS";
        const std::string name = is_filter ? first_word(entry) : "";
        if (!name.empty() && find_program(name, folder_of(ini)).empty()) {
            sink.warning("[FILTER]" + entry.key + ": there is no program '" + name +
                             "': files that end in ." + entry.key + " cannot be opened",
                         entry.place);
        }
    }
}

/// Checks subroutines that replace codes.
void examine_remaps(const IniFile &ini, diagnostics::Sink &sink) {
    std::vector<std::string> folders{ini.folder()};
    for (const auto &[section, key] :
         {std::pair("DISPLAY", "PROGRAM_PREFIX"), std::pair("RS274NGC", "SUBROUTINE_PATH")}) {
        const IniEntry *const entry = ini.find(section, key);
        std::istringstream parts(entry == nullptr ? "" : first_word(*entry));
        std::string folder;
        while (std::getline(parts, folder, ':')) {
            folders.push_back(ini.resolve_path(folder));
        }
    }
    for (const IniEntry *entry : ini.find_all("RS274NGC", "REMAP")) {
        for (const std::string &word : split_words(entry->value)) {
            const std::string file = word.starts_with("ngc=") ? word.substr(4) + ".ngc" : "";
            const auto holds = [&file](const std::string &folder) { return isThere(folder + '/' + file); };
            if (!file.empty() && std::ranges::none_of(folders, holds)) {
                sink.warning("[RS274NGC]REMAP: there is no file '" + file + "' in the folders of subroutines",
                             entry->place);
            }
        }
    }
}

}  // namespace

void examine_named_files(const IniFile &ini, const machine::MachineConfig &machine, diagnostics::Sink &sink) {
    for (const Named &named : FILES) {
        examine_file(ini, named, sink);
    }
    for (const Named &named : FOLDERS) {
        examine_folders(ini, named, sink);
    }
    examine_hal_names(ini, sink);
    examine_writing(machine.task.parameter_file, ini.find("RS274NGC", "PARAMETER_FILE"), sink);
    examine_writing(machine.tool_database.empty() ? machine.tool_table_file : std::string(),
                    ini.find("EMCIO", "TOOL_TABLE"), sink);
    examine_programs(ini, sink);
    examine_remaps(ini, sink);
}

}  // namespace mw::doctor
