// SPDX-License-Identifier: GPL-2.0-or-later
// Values and types of parameters, pins and signals.
#include <fmt/format.h>

#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

Result<> no_such_value(Instance &hal, const Word &word) {
    std::vector<std::string> names = pin_names(hal);
    for (std::string &name : param_names(hal)) {
        names.push_back(std::move(name));
    }
    return fail(fmt::format("parameter or pin '{}' does not exist", word.text), word.place,
                missing_hint(hal, word.text, names));
}

Result<> no_such_signal(Instance &hal, const Word &word) {
    return fail(fmt::format("signal '{}' does not exist", word.text), word.place,
                suggestion(word.text, signal_names(hal)));
}

bool hasValue(Instance &hal, const std::string &name) {
    return hal.params().has(name) || hal.pins().has(name);
}

}  // namespace

Result<> run_setp(Session &session, const Call &call) {
    Instance &hal = session.hal();
    const std::string &name = call.text(0);
    if (session.options().has_placeholders && session.placeholders().covers(name)) {
        session.placeholders().note(name);
        return {};
    }
    if (!hasValue(hal, name)) {
        return no_such_value(hal, call.words[0]);
    }
    const Result<> result = at(hal.values().set(name, std::string_view(call.text(1))), call.place_of(1));
    if (result) {
        const char *kind = hal.params().has(name) ? "Parameter" : "Pin";
        session.info(call.place, fmt::format("{} '{}' set to {}", kind, name, call.text(1)));
    }
    return result;
}

Result<> run_getp(Session &session, const Call &call) {
    const Result<Value> value = session.hal().values().get(call.text(0));
    if (!value) {
        return no_such_value(session.hal(), call.words[0]);
    }
    session.output().data(value->str() + "\n");
    return {};
}

Result<> run_ptype(Session &session, const Call &call) {
    const Result<Value> value = session.hal().values().get(call.text(0));
    if (!value) {
        return no_such_value(session.hal(), call.words[0]);
    }
    session.output().data(fmt::format("{}\n", type_name(value->type)));
    return {};
}

Result<> run_sets(Session &session, const Call &call) {
    Instance &hal = session.hal();
    if (!hal.signals().has(call.text(0))) {
        return no_such_signal(hal, call.words[0]);
    }
    const Result<> result =
        at(hal.signals().set(call.text(0), std::string_view(call.text(1))), call.place_of(1));
    if (result) {
        session.info(call.place, fmt::format("Signal '{}' set to {}", call.text(0), call.text(1)));
    }
    return result;
}

Result<> run_gets(Session &session, const Call &call) {
    const Result<Value> value = session.hal().signals().get(call.text(0));
    if (!value) {
        return no_such_signal(session.hal(), call.words[0]);
    }
    session.output().data(value->str() + "\n");
    return {};
}

Result<> run_stype(Session &session, const Call &call) {
    const Result<SignalInfo> signal = session.hal().signals().find(call.text(0));
    if (!signal) {
        return no_such_signal(session.hal(), call.words[0]);
    }
    session.output().data(fmt::format("{}\n", type_name(signal->type)));
    return {};
}

}  // namespace mw::hal::script
