// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc_var: the paths of this installation, for scripts.
#include <array>
#include <cstdio>
#include <string_view>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/own_place.hh"
#include "hal/script/session.hh"
#include "programs/commands.hh"
#include "programs/setup/configurations.hh"

namespace mw::programs {
namespace {

struct Variable {
    std::string_view name;
    std::string (*value)();
};

std::string hal_library() {
    for (const std::string &folder : hal::script::default_library()) {
        if (isFolder(folder)) {
            return canonical_path(folder);
        }
    }
    return {};
}

constexpr std::array VARIABLES{
    Variable{"LINUXCNCVERSION", [] { return std::string("2.9"); }},
    Variable{"LINUXCNC_AUX_GLADEVCP", [] { return std::string("/usr/share/linuxcnc/aux_gladevcp"); }},
    Variable{"LINUXCNC_AUX_EXAMPLES", [] { return std::string(AUX_EXAMPLES); }},
    Variable{"REALTIME", [] { return program_folder() + "/realtime"; }},
    Variable{"RTS", [] { return std::string("uspace"); }},
    Variable{"HALLIB_DIR", hal_library},
    Variable{"PYTHON", [] { return std::string("/usr/bin/python3"); }},
};

}  // namespace

int command_var(const std::vector<std::string> &words) {
    if (words.size() != 1 || words[0] == "-h" || words[0] == "--help") {
        const bool requested = words.size() == 1;
        fmt::print(
            requested ? stdout : stderr, "{}",
            language::shown(
                "usage: linuxcnc_var NAME | all\n\nPrints paths and values of this installation. Names:\n"));
        for (const Variable &variable : VARIABLES) {
            fmt::print(requested ? stdout : stderr, "  {}\n", variable.name);
        }
        return requested ? 0 : 2;
    }
    const bool all = words[0] == "all";
    bool found = all;
    for (const Variable &variable : VARIABLES) {
        if (all) {
            fmt::print("{}={}\n", variable.name, variable.value());
        } else if (variable.name == words[0]) {
            fmt::print("{}\n", variable.value());
            found = true;
        }
    }
    if (!found) {
        fmt::print("UNKNOWN\n");
    }
    return found ? 0 : 1;
}

}  // namespace mw::programs
