// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc: the launcher for desktop files, scripts and tests of configurations.
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/options/command_line.hh"
#include "base/options/letters.hh"
#include "base/own_place.hh"
#include "base/stop_signals.hh"
#include "base/whole_path.hh"
#include "hal/core/instance.hh"
#include "machine/config/loaded_config.hh"
#include "programs/command_words.hh"
#include "programs/commands.hh"
#include "programs/setup/configurations.hh"
#include "programs/setup/select_command.hh"
#include "programs/start/launch_environment.hh"
#include "programs/start/machine_start.hh"

namespace mw::programs {
namespace {

namespace fs = std::filesystem;

constexpr const char *USAGE =
    "usage: linuxcnc [options] [MACHINE.ini [words for the display]]\n"
    "\n"
    "Starts the machine with the display that [DISPLAY]DISPLAY names, and shuts both down when the display "
    "ends.\n"
    "Without an INI file, select a machine at the terminal (millwright select).\n"
    "\n"
    "  -l, -             the INI file that ~/.linuxcncrc names as the last one\n"
    "  -H FOLDER         HAL files are looked for there first; may be repeated\n"
    "  -k                continue after errors in HAL files\n"
    "  -m \"NAME PARAMS\"  a homing module, instead of [EMCMOT]HOMEMOD\n"
    "  -t \"NAME PARAMS\"  a planner module instead of [TRAJ]TPMOD\n"
    "  -d, -v            print more messages\n"
    "  -r                accepted for scripts: output is never redirected\n"
    "  -h                this help\n"
    "\n"
    "exit status: that of the display; 0 after a signal; 1 rejected or failed; 2 wrong usage\n";

constexpr std::array LETTERS{
    options::KnownLetter{'d'},
    options::KnownLetter{'v'},
    options::KnownLetter{'r'},
    options::KnownLetter{'l'},
    options::KnownLetter{'k'},
    options::KnownLetter{'h'},
    options::KnownLetter{'t', "a planner module"},
    options::KnownLetter{'m', "a homing module"},
    options::KnownLetter{'H', "a folder of HAL files"},
};

struct LaunchWords {
    StartSettings settings;
    bool help_asked = false, last_asked = false, saysMore = false;

    Result<> parse(const std::vector<std::string> &words) {
        auto read = options::read_letters(words, LETTERS, options::EndOfLetters::FIRST_WORD);
        if (!read.has_value()) {
            return std::unexpected(read.error());
        }
        for (const options::Letter &option : read->options) {
            if (auto taken = take(option); !taken.has_value()) {
                return taken;
            }
        }
        std::vector<std::string> &rest = read->words;
        if (!rest.empty() && rest[0] == "-") {
            last_asked = true;
            rest.erase(rest.begin());
        }
        if (!last_asked && !rest.empty()) {
            settings.ini = rest[0];
            rest.erase(rest.begin());
        }
        settings.display_words = rest;
        return {};
    }

  private:
    Result<> take(const options::Letter &option) {
        switch (option.letter) {
        case 'h': help_asked = true; break;
        case 'l': last_asked = true; break;
        case 'd':
        case 'v': saysMore = true; break;
        case 'k': settings.options.kept_going = true; break;
        case 'm': settings.options.homing_module = option.value; break;
        case 'H': settings.options.hal_folders.push_back(whole_path(option.value)); break;
        case 't': settings.options.planner_module = option.value; break;
        default: break;
        }
        return {};
    }
};

/// True if the person at the terminal wants to end the running machine.
bool isEndWanted(const std::string &ini) {
    fmt::print("A machine is already running: {}\nEnd it and start again? [Y/n] ", ini);
    std::fflush(stdout);
    std::array<char, 64> answer{};
    const bool answered = std::fgets(answer.data(), answer.size(), stdin) != nullptr;
    return answered && answer[0] != 'n' && answer[0] != 'N';
}

/// Ends the machine of `instance` and waits for its end.
Result<> end_machine(const std::string &instance) {
    constexpr double PATIENCE_S = 20;
    auto viewer = client::Viewer::attach(instance);
    if (!viewer.has_value()) {
        return {};  // it has ended in the meantime
    }
    const int pid = viewer->machine_pid();
    if (pid <= 0 || ::kill(pid, SIGTERM) != 0) {
        return fail("the running machine belongs to another user");
    }
    for (double waited_s = 0; viewer->isMachineAlive(); waited_s += 0.05) {
        if (waited_s > PATIENCE_S) {
            return fail("the running machine does not end");
        }
        ::usleep(50000);
    }
    return {};
}

/// Action of the launcher when a machine is running.
enum class SecondStart { GOES_ON, IS_LEFT, IS_REFUSED };

SecondStart settle_second_start(diagnostics::Sink &sink) {
    const std::string instance = hal::default_instance();
    const auto other = client::Viewer::attach(instance);
    if (!other.has_value() || !other->isMachineAlive() || ::isatty(STDIN_FILENO) == 0) {
        return SecondStart::GOES_ON;  // without a person to ask, the start itself reports the error
    }
    if (!isEndWanted(other->identity().ini.str())) {
        return SecondStart::IS_LEFT;
    }
    const auto ended = end_machine(instance);
    if (!ended.has_value()) {
        sink.failure(ended.error());
        return SecondStart::IS_REFUSED;
    }
    return SecondStart::GOES_ON;
}

int launch(LaunchWords &words, diagnostics::Sink &sink) {
    if (words.last_asked) {
        words.settings.ini = last_configuration();
        if (words.settings.ini.empty()) {
            sink.error("~/.linuxcncrc names no last configuration", {}, "name an INI file");
            return 1;
        }
    }
    std::error_code error;
    const fs::path ini = fs::absolute(words.settings.ini, error);
    words.settings.ini = ini.string();
    auto loaded = machine::LoadedConfig::load(words.settings.ini, sink);
    if (loaded == nullptr) {
        return 1;
    }
    switch (settle_second_start(sink)) {
    case SecondStart::IS_LEFT: return 0;
    case SecondStart::IS_REFUSED: return 1;
    case SecondStart::GOES_ON: break;
    }
    fmt::print("Machine configuration file is '{}'\n", words.settings.ini);
    std::fflush(stdout);
    set_launch_environment(*loaded, words.settings);
    fs::current_path(ini.parent_path(), error);
    return MachineStart(words.settings, *loaded, sink).run();
}

}  // namespace

int command_launch(const std::vector<std::string> &arguments) {
    LaunchWords words;
    const auto parsed = words.parse(arguments);
    if (words.help_asked) {
        fmt::print("{}", language::shown(USAGE));
        return 0;
    }
    const bool none_named = words.settings.ini.empty() && !words.last_asked;
    if (parsed.has_value() && none_named && ::isatty(STDIN_FILENO) != 0 && ::isatty(STDOUT_FILENO) != 0) {
        const auto chosen = select_configuration();
        if (!chosen.has_value() || chosen->empty()) {
            fmt::print(stderr, "{}",
                       chosen.has_value() ? "" : "linuxcnc: " + language::shown(chosen.error().str()) + "\n");
            return chosen.has_value() ? 0 : 1;
        }
        words.settings.ini = *chosen;
    } else if (!parsed.has_value() || none_named) {
        const std::string what = parsed.has_value() ? "name the INI file of a machine" : parsed.error().str();
        fmt::print(stderr, "linuxcnc: {}\n{}", language::shown(what), language::shown(USAGE));
        return 2;
    }
    catch_stop_signals();
    diagnostics::Sink sink = standard_error_sink();
    return launch(words, sink);
}

}  // namespace mw::programs
