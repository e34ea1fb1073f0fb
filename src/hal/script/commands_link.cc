// SPDX-License-Identifier: GPL-2.0-or-later
// Signals, links and aliases.
#include <fmt/format.h>

#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

Result<> check_pin(Instance &hal, const Word &word) {
    if (hal.pins().has(word.text)) {
        return {};
    }
    return fail(fmt::format("pin '{}' does not exist", word.text), word.place,
                missing_hint(hal, word.text, pin_names(hal)));
}

Result<> check_signal(Instance &hal, const Word &word) {
    if (hal.signals().has(word.text)) {
        return {};
    }
    return fail(fmt::format("signal '{}' does not exist", word.text), word.place,
                suggestion(word.text, signal_names(hal)));
}

/// Links one pin to an existing signal, or a placeholder instead.
Result<> link(Session &session, const Word &pin, const Word &signal) {
    Instance &hal = session.hal();
    if (session.options().has_placeholders && session.placeholders().covers(pin.text)) {
        return at(session.placeholders().link(pin.text, signal.text), pin.place);
    }
    Result<> result = check_signal(hal, signal);
    result = result ? check_pin(hal, pin) : result;
    result = result ? at(hal.signals().link(pin.text, signal.text), pin.place) : result;
    if (result) {
        session.info(pin.place, fmt::format("Pin '{}' linked to signal '{}'", pin.text, signal.text));
    }
    return result;
}

void warn_deprecated(Session &session, const Call &call) {
    session.warn(call.place, fmt::format("{} command is deprecated, use 'net'", call.spec.name));
}

enum class Kind { PIN, PARAM };

Result<Kind> kind_of(const Word &word) {
    if (word.text == "pin") {
        return Kind::PIN;
    }
    if (word.text == "param") {
        return Kind::PARAM;
    }
    return fail(fmt::format("'{}' is neither pin nor param", word.text), word.place);
}

/// Sets or (if empty) removes the alias of the object named by words 0 and 1.
Result<> set_alias(Session &session, const Call &call, const std::string &alias) {
    const Result<Kind> kind = kind_of(call.words[0]);
    if (!kind) {
        return std::unexpected(kind.error());
    }
    Instance &hal = session.hal();
    const std::string &name = call.text(1);
    if (*kind == Kind::PIN) {
        return at(hal.pins().set_alias(name, alias), call.place_of(1),
                  missing_hint(hal, name, pin_names(hal)));
    }
    return at(hal.params().set_alias(name, alias), call.place_of(1),
              missing_hint(hal, name, param_names(hal)));
}

}  // namespace

Result<> run_net(Session &session, const Call &call) {
    Instance &hal = session.hal();
    const Word &signal = call.words[0];
    if (hal.pins().has(signal.text) && !hal.signals().has(signal.text)) {
        return fail(fmt::format("signal name '{}' is the name of a pin", signal.text), signal.place,
                    "write the signal first: net SIGNAL PIN...");
    }
    std::vector<std::string> pins;
    std::vector<const Word *> placeholders;
    for (std::size_t i = 1; i < call.words.size(); ++i) {
        const Word &pin = call.words[i];
        if (session.options().has_placeholders && session.placeholders().covers(pin.text)) {
            placeholders.push_back(&pin);
            continue;
        }
        const Result<> found = check_pin(hal, pin);
        if (!found) {
            return found;
        }
        pins.push_back(pin.text);
    }
    if (!pins.empty()) {
        const Result<> linked = at(hal.signals().net(signal.text, pins), call.place_of(1));
        if (!linked) {
            return linked;
        }
        const Result<> waited = at(session.placeholders().signal_made(signal.text), signal.place);
        if (!waited) {
            return waited;
        }
    }
    for (const Word *pin : placeholders) {
        const Result<> linked = at(session.placeholders().link(pin->text, signal.text), pin->place);
        if (!linked) {
            return linked;
        }
    }
    for (const std::string &pin : pins) {
        session.info(call.place, fmt::format("Pin '{}' linked to signal '{}'", pin, signal.text));
    }
    return {};
}

Result<> run_linkpp(Session &session, const Call &call) {
    warn_deprecated(session, call);
    Instance &hal = session.hal();
    Result<> result = check_pin(hal, call.words[0]);
    result = result ? check_pin(hal, call.words[1]) : result;
    if (!result) {
        return result;
    }
    // The signal is named after the first pin and must be new.
    if (hal.signals().has(call.text(0))) {
        return fail(fmt::format("there is a signal '{}' already", call.text(0)), call.place_of(0));
    }
    result = at(hal.signals().create(call.text(0), hal.pins().find(call.text(0))->type), call.place_of(0));
    if (!result) {
        return result;
    }
    result = at(hal.signals().link(call.text(0), call.text(0)), call.place_of(0));
    result = result ? at(hal.signals().link(call.text(1), call.text(0)), call.place_of(1)) : result;
    if (!result) {
        // Removes a partly linked signal.
        (void)hal.signals().remove(call.text(0));
    }
    return result;
}

Result<> run_linkps(Session &session, const Call &call) {
    return link(session, call.words[0], call.words[1]);
}

Result<> run_linksp(Session &session, const Call &call) {
    return link(session, call.words[1], call.words[0]);
}

Result<> run_unlinkp(Session &session, const Call &call) {
    Instance &hal = session.hal();
    if (session.options().has_placeholders && session.placeholders().covers(call.text(0))) {
        return {};
    }
    Result<> result = check_pin(hal, call.words[0]);
    result = result ? at(hal.signals().unlink(call.text(0)), call.place_of(0)) : result;
    if (result) {
        session.info(call.place, fmt::format("Pin '{}' unlinked", call.text(0)));
    }
    return result;
}

Result<> run_newsig(Session &session, const Call &call) {
    const Result<Type> type = parse_type(call.text(1));
    if (!type) {
        return fail(fmt::format("unknown signal type '{}'", call.text(1)), call.place_of(1),
                    "bit, float, s32, u32, s64, u64 or port");
    }
    const Result<> made = at(session.hal().signals().create(call.text(0), *type), call.place_of(0));
    return made ? at(session.placeholders().signal_made(call.text(0)), call.place_of(0)) : made;
}

Result<> run_delsig(Session &session, const Call &call) {
    Instance &hal = session.hal();
    if (call.text(0) == "all") {
        Result<> result;
        for (const std::string &name : signal_names(hal)) {
            const Result<> deleted = hal.signals().remove(name);
            result = result ? deleted : result;
        }
        return at(result, call.place_of(0));
    }
    Result<> result = check_signal(hal, call.words[0]);
    result = result ? at(hal.signals().remove(call.text(0)), call.place_of(0)) : result;
    if (result) {
        session.info(call.place, fmt::format("Signal '{}' deleted", call.text(0)));
    }
    return result;
}

Result<> run_alias(Session &session, const Call &call) {
    const Result<> result = set_alias(session, call, call.text(2));
    if (result) {
        session.info(call.place,
                     fmt::format("{} '{}' aliased to '{}'", call.text(0), call.text(1), call.text(2)));
    }
    return result;
}

Result<> run_unalias(Session &session, const Call &call) {
    const Result<> result = set_alias(session, call, "");
    if (result) {
        session.info(call.place, fmt::format("{} '{}' unaliased", call.text(0), call.text(1)));
    }
    return result;
}

}  // namespace mw::hal::script
