// SPDX-License-Identifier: GPL-2.0-or-later
// mb2hal config=FILE.ini: Modbus devices as pins of HAL (man page mb2hal).
#include <cstdio>
#include <string>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "base/language/language.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "drivers/modbus/component.hh"

namespace {

constexpr const char *USAGE = R"(usage: mb2hal config=FILE.ini

Polls Modbus devices by RTU or TCP and exports their values as HAL pins. The man page mb2hal describes the file.

exit status: 0 ended by a signal, 1 failed, 2 wrong usage
)";
constexpr std::string_view CONFIG = "config=";

}  // namespace

int main(int argc, char **argv) {
    mw::tell_when_memory_ends();
    const std::string word = argc == 2 ? argv[1] : "";
    const bool is_help = word == "-h" || word == "--help";
    if (is_help || !word.starts_with(CONFIG) || word.size() == CONFIG.size()) {
        std::fputs(mw::language::shown(USAGE).c_str(), is_help ? stdout : stderr);
        return is_help ? 0 : 2;
    }
    mw::diagnostics::Sink sink(
        [](const mw::diagnostics::Diagnostic &found) { mw::language::tell(found.str()); });
    const auto file = mw::ini::IniFile::load(word.substr(CONFIG.size()), sink);
    if (!file.has_value()) {
        mw::language::tell("mb2hal", file.error());
        return 1;
    }
    const mw::modbus::Setup setup = mw::modbus::read_setup(*file, sink);
    if (sink.hasErrors()) {
        return 1;
    }
    mw::catch_stop_signals();
    const auto done = mw::modbus::run(setup, mw::stop_signal);
    if (!done.has_value()) {
        mw::language::tell("mb2hal", done.error());
    }
    return done.has_value() ? 0 : 1;
}
