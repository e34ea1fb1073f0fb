// SPDX-License-Identifier: GPL-2.0-or-later
#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "hal/script/two_pass.hh"
#include "hal/tools/programs/command_line.hh"

namespace mw::hal::tools {

namespace {

constexpr const char *USAGE = R"(usage: halcmd_twopass [OPTIONS] INI

Runs the files of [HAL]HALFILE in two passes: loadrt lines for one module are merged. INI needs [HAL]TWOPASS.

  -k  continue after failed commands    -q -Q -v -V  fewer or more messages (see halcmd -h)
)";

int fail_with(const Error &error) {
    language::tell("halcmd_twopass", error);
    return 1;
}

/// The value of [HAL]TWOPASS.
Result<std::string> two_pass_keywords(const ini::IniFile &ini) {
    const ini::IniEntry *entry = ini.find("HAL", "TWOPASS");
    if (entry == nullptr || entry->value.empty()) {
        return fail("an INI file can only be used here when it has [HAL]TWOPASS",
                    ini.place_of_section("HAL"));
    }
    return entry->value;
}

}  // namespace

Result<> run_two_pass_ini(script::Session &session, const ini::IniFile &ini) {
    const Result<std::string> keywords = two_pass_keywords(ini);
    if (!keywords) {
        return std::unexpected(keywords.error());
    }
    std::vector<script::HalFileEntry> files;
    for (const ini::IniEntry *entry : ini.find_all("HAL", "HALFILE")) {
        files.push_back({entry->value, entry->place});
    }
    session.options().folders.insert(session.options().folders.begin(), ini.folder());
    Result<> result = script::run_two_pass(session, files, *keywords, script::TwoPassReport::FILES);
    for (const ini::IniEntry *entry : ini.find_all("HAL", "HALCMD")) {
        result = result ? session.run_text(entry->value, entry->place.str()) : result;
    }
    return result;
}

int halcmd_twopass(const std::vector<std::string> &arguments) {
    Result<CommandLine> line = parse_command_line(arguments);
    if (line && line->wants_help) {
        std::fputs(language::shown(USAGE).c_str(), stdout);
        return 0;
    }
    if (!line || line->words.size() != 1) {
        std::fputs(language::shown(USAGE).c_str(), stderr);
        return line ? 1 : fail_with(line.error());
    }
    IniOption ini;
    if (const Result<> loaded = ini.load(line->words[0]); !loaded) {
        return fail_with(loaded.error());
    }
    line->session.ini = ini.lookup();
    if (const auto keywords = two_pass_keywords(*ini.file()); !keywords) {
        return fail_with(keywords.error());
    }
    Result<JoinedHost> host = join_or_start();
    if (!host) {
        return fail_with(host.error());
    }
    script::StandardOutput output;
    script::SystemProgramHost programs((*host)->hal());
    script::Session session(**host, programs, output, line->session);
    const Result<> result = run_two_pass_ini(session, *ini.file());
    if (programs.hasStarted()) {
        host->keep();
    }
    return result ? 0 : 1;
}

}  // namespace mw::hal::tools
