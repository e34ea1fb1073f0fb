// SPDX-License-Identifier: GPL-2.0-or-later
// millwright doctor, linuxcnc_check_ini: finds errors in a machine before it is started.
#include <unistd.h>

#include <array>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "base/ini/ini_file.hh"
#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/options/letters.hh"
#include "base/stop_signals.hh"
#include "base/text.hh"
#include "clients/screen/assembly/ini_facts.hh"
#include "clients/screen/hal/dialog_facts.hh"
#include "programs/commands.hh"
#include "programs/doctor/examine.hh"

namespace mw::programs {
namespace {

struct DoctorWords {
    doctor::Scope scope;
    bool strict = false;
    options::Words rest;

    options::CommandLine line() {
        options::CommandLine line(
            "millwright doctor MACHINE.ini [options]",
            "Checks an INI file, the files that it names, its HAL files and this computer before the machine "
            "is started,\nand measures latency. Prints one finding per line: file, line, column, severity, "
            "remedy.\nHAL files run with a virtual clock, without the programs of loadusr; Tcl files also "
            "run.\n");
        line.number("--latency", "SECONDS", "duration of the latency measurement, 0: none (10)",
                    scope.latency_s, 0, 86400);
        line.flag("--no-hal", "do not check HAL files and unknown keys", scope.has_hal, false);
        line.flag("--no-system", "do not check the computer", scope.has_system, false);
        line.flag("--strict", "warnings count as errors", strict);
        line.rest(rest);
        line.footer("exit status: 0 the machine can be started, 1 there are errors, 2 wrong usage\n");
        return line;
    }
};

struct Counted {
    int errors = 0, warnings = 0;

    void count(const diagnostics::Diagnostic &finding) {
        errors += finding.severity == diagnostics::Severity::ERROR ? 1 : 0;
        warnings += finding.severity == diagnostics::Severity::WARNING ? 1 : 0;
    }
};

/// In the format of linuxcnc_check_ini's lines: "INI: error: text".
const char *kind_of(diagnostics::Severity severity) {
    switch (severity) {
    case diagnostics::Severity::ERROR: return "error";
    case diagnostics::Severity::WARNING: return "warning";
    case diagnostics::Severity::NOTE: break;
    }
    return "info";
}

/// The settings of our screen, read as by the screen; other displays have their own readers.
void examine_screen(const machine::LoadedConfig &loaded, diagnostics::Sink &sink) {
    const std::vector<std::string> words = split_words(loaded.machine.display);
    if (!words.empty() && words[0] == "millwright") {
        static_cast<void>(screen::machine_facts(loaded, sink));
        static_cast<void>(screen::status_period_s(loaded.ini, sink));
        static_cast<void>(screen::dialog_facts(loaded.ini, sink));
    }
}

}  // namespace

int command_doctor(const std::vector<std::string> &arguments) {
    DoctorWords words;
    if (options::wantsHelp(arguments)) {
        fmt::print("{}", words.line().help());
        return 0;
    }
    const auto parsed = words.line().parse(arguments);
    if (!parsed.has_value() || words.rest.size() != 1) {
        fmt::print(stderr, "millwright doctor: {}\n",
                   language::shown(parsed.has_value() ? "needs one machine: millwright doctor MACHINE.ini"
                                                      : parsed.error().str()));
        return 2;
    }
    catch_stop_signals();
    Counted counted;
    // Discards the output of HAL files, because findings are printed.
    const auto close = [](std::FILE *file) { std::fclose(file); };
    const std::unique_ptr<std::FILE, decltype(close)> out(::fdopen(::dup(STDOUT_FILENO), "w"), close);
    diagnostics::Sink sink([&](const diagnostics::Diagnostic &finding) {
        counted.count(finding);
        fmt::print(out.get(), "{}\n", language::shown(doctor::finding_line(finding)));
        std::fflush(out.get());
    });
    words.scope.display = examine_screen;
    doctor::examine(words.rest[0], words.scope, stop_signal, sink);
    fmt::print(stderr, "{}",
               language::shown(fmt::format("{}: errors: {}, warnings: {}\n", words.rest[0], counted.errors,
                                           counted.warnings)));
    return counted.errors > 0 || (words.strict && counted.warnings > 0) ? 1 : 0;
}

int command_check_ini(const std::vector<std::string> &arguments) {
    constexpr std::array LETTERS{options::KnownLetter{'e'}, options::KnownLetter{'h'}};
    constexpr const char *USAGE = "usage: linuxcnc_check_ini [-e] MACHINE.ini\n"
                                  "\n"
                                  "Checks the settings of an INI file and the files that it names.\n"
                                  "\n"
                                  "  -e  warnings count as errors\n"
                                  "\n"
                                  "exit status: 0 no error, 1 errors, 2 wrong usage or no such file\n";
    const auto read = options::read_letters(arguments, LETTERS, options::EndOfLetters::FIRST_WORD);
    bool strict = false, help_asked = false;
    if (read.has_value()) {
        for (const options::Letter &option : read->options) {
            strict |= option.letter == 'e';
            help_asked |= option.letter == 'h';
        }
    }
    if (help_asked || !read.has_value() || read->words.size() != 1) {
        fmt::print(help_asked ? stdout : stderr, "{}", language::shown(USAGE));
        return help_asked ? 0 : 2;
    }
    const std::string &ini = read->words[0];
    diagnostics::Sink unheard;
    if (const auto file = ini::IniFile::load(ini, unheard); !file.has_value()) {
        fmt::print(stderr, "{}: error: {}\n", ini, file.error().str());
        return 2;
    }
    Counted counted;
    diagnostics::Sink sink([&](const diagnostics::Diagnostic &finding) {
        counted.count(finding);
        fmt::print(stderr, "{}: {}: {}\n", ini, kind_of(finding.severity),
                   language::shown(finding.what.str()));
    });
    doctor::examine(ini, {.has_hal = false, .has_system = false, .latency_s = 0, .display = examine_screen},
                    stop_signal, sink);
    return counted.errors > 0 || (strict && counted.warnings > 0) ? 1 : 0;
}

}  // namespace mw::programs
