// SPDX-License-Identifier: GPL-2.0-or-later
#include <cstdio>

#include "base/language/language.hh"
#include "hal/tools/programs/command_line.hh"

namespace mw::hal::tools {

namespace {

constexpr const char *USAGE = R"(usage: haltcl [-i INI] [FILE [ARGUMENT...]]

Runs a Tcl script with the HAL commands in the running realtime process, or reads commands from standard input.

  -i INI  its entries become arrays: $::SECTION(ITEM)
)";

int fail_with(const Error &error) {
    language::tell("haltcl", error);
    return 1;
}

}  // namespace

int haltcl(const std::vector<std::string> &given) {
    std::vector<std::string> arguments = given;
    std::string ini_path;
    const bool has_ini = arguments.size() >= 2 && (arguments[0] == "-i" || arguments[0] == "-ini");
    if (has_ini) {
        ini_path = arguments[1];
        arguments.erase(arguments.begin(), arguments.begin() + 2);
    }
    if (!arguments.empty() && arguments[0].starts_with('-')) {
        const bool is_help = arguments[0] == "-h" || arguments[0] == "--help";
        std::fputs(language::shown(USAGE).c_str(), is_help ? stdout : stderr);
        return is_help ? 0 : 1;
    }
    IniOption ini;
    if (const Result<> loaded = ini.load(ini_path); !loaded) {
        return fail_with(loaded.error());
    }
    script::SessionOptions options;
    options.library = script::default_library();
    options.ini = ini.lookup();
    Result<JoinedHost> host = join_or_start();
    if (!host) {
        return fail_with(host.error());
    }
    script::StandardOutput output;
    script::SystemProgramHost programs((*host)->hal());
    script::Session session(**host, programs, output, options);
    const Result<script::ScriptRunner *> tcl = session.tcl();
    if (!tcl) {
        return fail_with(tcl.error());
    }
    const Result<> result = arguments.empty()
                                ? (*tcl)->run_standard_input()
                                : (*tcl)->run_file(arguments[0], {arguments.begin() + 1, arguments.end()});
    if (programs.hasStarted()) {
        host->keep();
    }
    if (!result && !arguments.empty()) {
        output.error(result.error());
    }
    return result ? 0 : 1;
}

}  // namespace mw::hal::tools
