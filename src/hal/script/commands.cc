// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/commands.hh"

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/text.hh"

namespace mw::hal::script {

namespace {

constexpr int ANY = CommandSpec::ANY;

constexpr CommandSpec COMMANDS[] = {
    {"loadrt", 1, ANY, false, "MODULE [NAME=VALUE...]", "Loads a realtime module with its parameters.",
     run_loadrt},
    {"loadusr", 1, ANY, false, "[-W] [-Wn NAME] [-w] [-i] PROGRAM [ARGUMENT...]",
     "Starts a program. -W waits until its component (named as the program, or NAME with -Wn) is ready, -w "
     "until it\n"
     "has ended, -i with -w accepts any exit status.",
     run_loadusr},
    {"waitusr", 1, 1, false, "COMPONENT", "Waits until the program of a component has ended.", run_waitusr},
    {"unload", 1, 1, false, "COMPONENT|all", "Ends a program or unloads a realtime module, or all of both.",
     run_unload},
    {"unloadrt", 1, 1, false, "MODULE|all", "Unloads a realtime module, or all, newest first.", run_unloadrt},
    {"unloadusr", 1, 1, false, "COMPONENT|all", "Ends the program of a component, or all programs.",
     run_unloadusr},
    {"lock", 0, 1, false, "[none|tune|all]",
     "Locks HAL: tune still allows setting values and starting threads; all (default) allows no change.",
     run_lock},
    {"unlock", 0, 1, false, "[tune|all]",
     "Unlocks HAL: tune removes the lock of tune; all (default) removes all locks.", run_unlock},
    {"net", 2, ANY, true, "SIGNAL PIN...",
     "Links pins to a signal. A signal that does not exist is created with the type of the first pin. Arrows "
     "between the\nnames have no effect.",
     run_net},
    {"linkpp", 2, 2, true, "PIN PIN", "Links two pins by a signal named as the first. Use net instead.",
     run_linkpp},
    {"linkps", 2, 2, true, "PIN SIGNAL", "Links a pin to a signal that exists. Use net instead.", run_linkps},
    {"linksp", 2, 2, true, "SIGNAL PIN", "Links a pin to a signal that exists. Use net instead.", run_linksp},
    {"unlinkp", 1, 1, false, "PIN", "Unlinks a pin; it keeps the value it has.", run_unlinkp},
    {"newsig", 2, 2, false, "SIGNAL bit|float|s32|u32|s64|u64|port", "Creates a signal.", run_newsig},
    {"delsig", 1, 1, false, "SIGNAL|all", "Removes a signal, unlinking its pins.", run_delsig},
    {"alias", 3, 3, false, "pin|param NAME ALIAS",
     "Sets an alias of a pin or parameter. Lists show the alias.", run_alias},
    {"unalias", 2, 2, false, "pin|param NAME", "Removes an alias.", run_unalias},
    {"setp", 2, 2, false, "NAME VALUE",
     "Sets a parameter, or a pin that is an unlinked input. NAME = VALUE is the same.", run_setp},
    {"getp", 1, 1, false, "NAME", "Prints the value of a parameter or pin.", run_getp},
    {"ptype", 1, 1, false, "NAME", "Prints the type of a parameter or pin.", run_ptype},
    {"sets", 2, 2, false, "SIGNAL VALUE", "Sets a signal that no output drives.", run_sets},
    {"gets", 1, 1, false, "SIGNAL", "Prints the value of a signal.", run_gets},
    {"stype", 1, 1, false, "SIGNAL", "Prints the type of a signal.", run_stype},
    {"addf", 2, 3, false, "FUNCTION THREAD [POSITION]",
     "Adds a function to a thread, last or at POSITION (1 first, -1 last).", run_addf},
    {"initf", 2, 3, false, "FUNCTION THREAD [POSITION]",
     "Adds a function that runs once, when the thread starts, before the others.", run_initf},
    {"delf", 2, 2, false, "FUNCTION THREAD", "Removes a function from a thread.", run_delf},
    {"show", 0, ANY, false, "[comp|pin|sig|param|funct|thread|alias|all [-tTYPE] [PATTERN...]]",
     "Prints HAL items with values and links. PATTERN may contain * ? and [abc], or is the beginning of "
     "names; -tfloat\nshows only items of this type.",
     run_show},
    {"list", 1, ANY, false, "comp|pin|sig|param|funct|thread [-tTYPE] [PATTERN...]",
     "Prints names in one line; -tfloat only those of that type.", run_list},
    {"save", 0, 2, false,
     "[comp|alias|sig|sigu|link|linka|net|neta|netl|netla|param|thread|unconnectedinpins|all|allu [FILE]]",
     "Prints the state as HAL commands, or writes them to FILE. all: comp alias sigu netla param thread; "
     "allu: with\n"
     "unconnectedinpins.",
     run_save},
    {"status", 0, 1, false, "[lock|mem|all]",
     "Prints the lock state, the memory use, and the components whose process has died.", run_status},
    {"start", 0, 0, false, "", "Starts the threads: they call their functions.", run_start},
    {"stop", 0, 0, false, "", "Stops the threads.", run_stop},
    {"source", 1, 1, false, "FILE",
     "Runs the commands of another file; LIB:FILE is a file of the HAL library.", run_source},
    {"echo", 0, 0, false, "", "Echoes each command to standard error from now on.", run_echo},
    {"unecho", 0, 0, false, "", "Ends echo.", run_unecho},
    {"print", 0, 1, false, "[TEXT]", "Prints file, line and a text to standard error.", run_print},
    {"debug", 1, 1, false, "LEVEL",
     "Sets the log level: 0 nothing, 1 errors, 2 warnings, 3 information, 4 debugging, 5 everything.",
     run_debug},
    {"help", 0, 1, false, "[COMMAND]", "Explains a command, or lists all.", run_help},
    {"exit", 0, 0, false, "", "Ends the input.", run_exit},
    {"quit", 0, 0, false, "", "Ends the input.", run_exit},
    {"setexact_for_test_suite_only", 0, 0, false, "",
     "Accepted for compatibility: threads always have exact periods.", run_setexact},
};

std::vector<std::string> command_names() {
    std::vector<std::string> names;
    for (const CommandSpec &spec : COMMANDS) {
        names.emplace_back(spec.name);
    }
    return names;
}

}  // namespace

std::span<const CommandSpec> commands() {
    return COMMANDS;
}

const CommandSpec *find_command(std::string_view name) {
    for (const CommandSpec &spec : COMMANDS) {
        if (spec.name == name) {
            return &spec;
        }
    }
    return nullptr;
}

Error unknown_command(const Word &word) {
    Error error{fmt::format("unknown command '{}'", word.text), word.place, {}};
    if (word.raw.find('=') != std::string::npos) {
        error.hint = "an assignment needs blanks around '='";
    } else {
        error.hint = suggestion(word.text, command_names());
    }
    return error;
}

namespace {

/// Translated as whole sentences, because singular and plural differ in many languages.
std::string word_count_text(const CommandSpec &spec, int given) {
    const bool is_one = spec.min_words == 1;
    if (spec.max_words == ANY && is_one) {
        return fmt::format("{} needs at least 1 argument, {} given", spec.name, given);
    }
    if (spec.max_words == ANY) {
        return fmt::format("{} needs at least {} arguments, {} given", spec.name, spec.min_words, given);
    }
    if (spec.max_words != spec.min_words) {
        return fmt::format("{} needs {} to {} arguments, {} given", spec.name, spec.min_words, spec.max_words,
                           given);
    }
    return is_one ? fmt::format("{} needs 1 argument, {} given", spec.name, given)
                  : fmt::format("{} needs {} arguments, {} given", spec.name, spec.min_words, given);
}

}  // namespace

Result<> check_words(const Call &call) {
    const int given = static_cast<int>(call.words.size());
    const CommandSpec &spec = call.spec;
    const bool is_too_few = given < spec.min_words;
    const bool is_too_many = spec.max_words != ANY && given > spec.max_words;
    if (!is_too_few && !is_too_many) {
        return {};
    }
    const SourcePlace &place =
        is_too_many ? call.place_of(static_cast<std::size_t>(spec.max_words)) : call.place;
    return fail(word_count_text(spec, given), place, fmt::format("{} {}", spec.name, spec.synopsis));
}

std::string help_text(const CommandSpec &spec) {
    return fmt::format("{} {}\n{}\n", spec.name, spec.synopsis, language::shown(spec.help));
}

std::string help_overview() {
    std::string text;
    for (const CommandSpec &spec : COMMANDS) {
        const std::string help = language::shown(spec.help);
        text += fmt::format("  {:<10}  {}\n", spec.name, help.substr(0, help.find('\n')));
    }
    return text + language::shown("'help COMMAND' describes a command.\n");
}

Result<> at(Result<> result, const SourcePlace &place, const std::string &hint) {
    if (!result) {
        Error &error = result.error();
        if (error.place.file.empty() && error.place.line == 0) {
            error.place = place;
        }
        if (error.hint.empty()) {
            error.hint = hint;
        }
    }
    return result;
}

std::string suggestion(std::string_view name, const std::vector<std::string> &candidates) {
    const std::string near = nearest_name(name, candidates);
    return near.empty() ? "" : fmt::format("did you mean '{}'?", near);
}

std::string missing_hint(Instance &hal, std::string_view name, const std::vector<std::string> &candidates) {
    for (const DeathInfo &death : hal.processes().deaths()) {
        if (name == death.name || name.starts_with(death.name + ".")) {
            return fmt::format("component '{}' died with its process {}", death.name, death.pid);
        }
    }
    return suggestion(name, candidates);
}

std::vector<std::string> pin_names(Instance &hal) {
    std::vector<std::string> names;
    for (const PinInfo &pin : hal.pins().list()) {
        names.push_back(pin.name);
    }
    return names;
}

std::vector<std::string> param_names(Instance &hal) {
    std::vector<std::string> names;
    for (const ParamInfo &param : hal.params().list()) {
        names.push_back(param.name);
    }
    return names;
}

std::vector<std::string> signal_names(Instance &hal) {
    std::vector<std::string> names;
    for (const SignalInfo &signal : hal.signals().list()) {
        names.push_back(signal.name);
    }
    return names;
}

}  // namespace mw::hal::script
