// SPDX-License-Identifier: GPL-2.0-or-later
// Modules, programs and threads.
#include <unistd.h>

#include <algorithm>

#include <fmt/format.h>

#include "base/text.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

/// Reads the options of loadusr; the words from the program's name on become argv.
Result<ProgramRequest> parse_loadusr(const Call &call) {
    ProgramRequest request;
    std::size_t i = 0;
    bool named = false;
    for (; i < call.words.size() && call.text(i).starts_with('-'); ++i) {
        const std::string &word = call.text(i);
        if (word == "-Wn") {
            if (i + 1 >= call.words.size()) {
                return fail("-Wn needs the name of a component", call.place_of(i));
            }
            request.wait = ProgramRequest::Wait::UNTIL_READY;
            request.component = call.text(++i);
            named = true;
            continue;
        }
        for (const char option : word.substr(1)) {
            if (option == 'W') {
                request.wait = ProgramRequest::Wait::UNTIL_READY;
            } else if (option == 'w') {
                request.wait = ProgramRequest::Wait::UNTIL_END;
            } else if (option == 'i') {
                request.ignoresStatus = true;
            } else {
                return fail(fmt::format("unknown option '-{}' of loadusr", option), call.place_of(i),
                            fmt::format("loadusr {}", call.spec.synopsis));
            }
        }
    }
    for (; i < call.words.size(); ++i) {
        request.argv.push_back(call.text(i));
    }
    if (request.argv.empty()) {
        return fail("loadusr needs the name of a program", call.place);
    }
    if (!named) {
        const std::string name = base_name(request.argv[0]);
        request.component = name.ends_with(".py") ? name.substr(0, name.size() - 3) : name;
    }
    return request;
}

Result<> unload_module(Session &session, const std::string &name) {
    return session.host().unload_realtime(name);
}

/// Unloads the modules, newest first. Tries all, then returns the first failure.
Result<> unload_all_modules(Session &session) {
    Result<> result;
    // Threads must not call functions that are being removed.
    if (session.hal().threads().isRunning()) {
        result = session.hal().threads().stop();
    }
    const Result<std::vector<std::string>> modules = session.host().modules();
    if (!modules) {
        return std::unexpected(modules.error());
    }
    for (auto module = modules->rbegin(); module != modules->rend(); ++module) {
        const Result<> unloaded = unload_module(session, *module);
        result = result ? unloaded : result;
    }
    return result;
}

std::vector<std::string> component_names(Session &session, CompType type) {
    std::vector<std::string> names;
    for (const CompInfo &component : session.hal().components().list()) {
        const bool own = component.type == CompType::USER && component.pid == getpid();
        if (component.type == type && !own) {
            names.push_back(component.name);
        }
    }
    return names;
}

std::unexpected<Error> not_loaded(Session &session, const Word &word, CompType type) {
    return fail(fmt::format("component '{}' is not loaded", word.text), word.place,
                missing_hint(session.hal(), word.text, component_names(session, type)));
}

/// A program that has ended already is not an error.
Result<> warn_not_loaded(Session &session, const Word &word) {
    const Error error = not_loaded(session, word, CompType::USER).error();
    session.warn(error.place, error.message, error.hint);
    return {};
}

/// The position for addf and initf: not zero.
Result<int> parse_position(const Call &call) {
    if (call.words.size() < 3) {
        return -1;
    }
    const std::optional<std::int64_t> position = parse_int(call.text(2));
    if (!position || *position == 0 || *position > 10000 || *position < -10000) {
        return fail(fmt::format("'{}' is not a position", call.text(2)), call.place_of(2),
                    "1 is the first position, -1 the last");
    }
    return static_cast<int>(*position);
}

Result<> check_function_and_thread(Session &session, const Call &call) {
    std::vector<std::string> functions;
    for (const FunctionInfo &function : session.hal().functions().list()) {
        functions.push_back(function.name);
    }
    if (std::find(functions.begin(), functions.end(), call.text(0)) == functions.end()) {
        return fail(fmt::format("function '{}' does not exist", call.text(0)), call.place_of(0),
                    suggestion(call.text(0), functions));
    }
    std::vector<std::string> threads;
    for (const ThreadInfo &thread : session.hal().threads().list()) {
        threads.push_back(thread.name);
    }
    if (std::find(threads.begin(), threads.end(), call.text(1)) == threads.end()) {
        std::string hint = suggestion(call.text(1), threads);
        hint = threads.empty() ? "there is no thread yet" : hint;
        return fail(fmt::format("thread '{}' does not exist", call.text(1)), call.place_of(1), hint);
    }
    return {};
}

}  // namespace

Result<> run_loadrt(Session &session, const Call &call) {
    std::vector<std::string> args;
    for (std::size_t i = 1; i < call.words.size(); ++i) {
        args.push_back(call.text(i));
    }
    const Result<> loaded = at(session.host().load_realtime(call.text(0), args), call.place_of(0));
    if (loaded) {
        session.info(call.place, fmt::format("Realtime module '{}' loaded", call.text(0)));
    }
    return loaded;
}

Result<> run_loadusr(Session &session, const Call &call) {
    const Result<ProgramRequest> request = parse_loadusr(call);
    if (!request) {
        return std::unexpected(request.error());
    }
    const Result<ProgramStart> started = session.programs().start(*request);
    if (!started) {
        return at(std::unexpected(started.error()), call.place);
    }
    if (*started == ProgramStart::LEFT_OUT) {
        session.placeholders().add_program(request->component, request->argv);
        return {};
    }
    const bool ended = request->wait == ProgramRequest::Wait::UNTIL_END;
    session.info(call.place,
                 fmt::format("Program '{}' {}", request->argv[0], ended ? "finished" : "started"));
    if (request->wait == ProgramRequest::Wait::UNTIL_READY) {
        session.info(call.place, fmt::format("Component '{}' ready", request->component));
    }
    return {};
}

Result<> run_waitusr(Session &session, const Call &call) {
    if (!session.hal().components().has(call.text(0))) {
        return warn_not_loaded(session, call.words[0]);
    }
    const Result<> ended = at(session.programs().wait_for_end(call.text(0)), call.place_of(0));
    for (const DeathInfo &death : session.hal().processes().deaths()) {
        if (ended && death.name == call.text(0)) {
            session.warn(call.place_of(0), fmt::format("component '{}' died: its process {} ended without "
                                                       "hal_exit; its outputs have their safe values",
                                                       death.name, death.pid));
        }
    }
    return ended;
}

Result<> run_unloadusr(Session &session, const Call &call) {
    if (call.text(0) == "all") {
        return at(session.programs().stop_all(), call.place_of(0));
    }
    const Result<CompInfo> component = session.hal().components().find(call.text(0));
    if (!component) {
        return warn_not_loaded(session, call.words[0]);
    }
    if (component->type != CompType::USER) {
        return fail(fmt::format("component '{}' is not a program", call.text(0)), call.place_of(0),
                    "use unloadrt for a realtime module");
    }
    return at(session.programs().stop(call.text(0)), call.place_of(0));
}

Result<> run_unloadrt(Session &session, const Call &call) {
    if (call.text(0) == "all") {
        return at(unload_all_modules(session), call.place_of(0));
    }
    const Result<bool> is_loaded = session.host().isModuleLoaded(call.text(0));
    if (is_loaded && !*is_loaded) {
        return not_loaded(session, call.words[0], CompType::REALTIME);
    }
    const Result<> unloaded = at(unload_module(session, call.text(0)), call.place_of(0));
    if (unloaded) {
        session.info(call.place, fmt::format("Realtime module '{}' unloaded", call.text(0)));
    }
    return unloaded;
}

Result<> run_unload(Session &session, const Call &call) {
    if (call.text(0) == "all") {
        const Result<> programs = at(session.programs().stop_all(), call.place_of(0));
        const Result<> modules = at(unload_all_modules(session), call.place_of(0));
        return programs ? modules : programs;
    }
    const Result<CompInfo> component = session.hal().components().find(call.text(0));
    const bool is_program = component && component->type == CompType::USER;
    return is_program ? run_unloadusr(session, call) : run_unloadrt(session, call);
}

Result<> run_addf(Session &session, const Call &call) {
    const Result<int> position = parse_position(call);
    if (!position) {
        return std::unexpected(position.error());
    }
    Result<> result = check_function_and_thread(session, call);
    result = result ? at(session.hal().threads().add_function(call.text(0), call.text(1), *position),
                         call.place_of(0))
                    : result;
    if (result) {
        session.info(call.place,
                     fmt::format("Function '{}' added to thread '{}'", call.text(0), call.text(1)));
    }
    return result;
}

Result<> run_initf(Session &session, const Call &call) {
    const Result<int> position = parse_position(call);
    if (!position) {
        return std::unexpected(position.error());
    }
    Result<> result = check_function_and_thread(session, call);
    result = result ? at(session.hal().threads().add_init_function(call.text(0), call.text(1), *position),
                         call.place_of(0))
                    : result;
    if (result) {
        session.info(call.place,
                     fmt::format("Function '{}' added once to thread '{}'", call.text(0), call.text(1)));
    }
    return result;
}

Result<> run_delf(Session &session, const Call &call) {
    Result<> result = check_function_and_thread(session, call);
    result = result
                 ? at(session.hal().threads().remove_function(call.text(0), call.text(1)), call.place_of(0))
                 : result;
    if (result) {
        session.info(call.place,
                     fmt::format("Function '{}' removed from thread '{}'", call.text(0), call.text(1)));
    }
    return result;
}

Result<> run_start(Session &session, const Call &call) {
    const Result<> result = at(session.hal().threads().start(), call.place);
    if (result) {
        session.info(call.place, "Realtime threads started");
    }
    return result;
}

Result<> run_stop(Session &session, const Call &call) {
    const Result<> result = at(session.hal().threads().stop(), call.place);
    if (result) {
        session.info(call.place, "Realtime threads stopped");
    }
    return result;
}

}  // namespace mw::hal::script
