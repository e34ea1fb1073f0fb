// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/orders.hh"

#include <algorithm>

#include <fmt/format.h>

#include "clients/rsh/machine_orders.hh"
#include "clients/rsh/motion_orders.hh"

namespace mw::rsh {
namespace {

enum class SpokenBy : std::uint8_t { BOTH, NEWER, OLD };

struct Row {
    SpokenBy dialect;
    Order order;
};

Result<Waiting> done() {
    return Waiting{};
}

/// Sets a switch of the connection: ON or OFF.
template <bool OwnState::*SETTING>
Result<Waiting> switch_own(const Ordered &o) {
    const auto isOn = o.words.empty() ? on_or_off("") : on_or_off(o.words[0]);
    if (!isOn.has_value()) {
        return std::unexpected(isOn.error());
    }
    o.own.*SETTING = *isOn;
    return done();
}

/// One word of several.
template <class Value>
Result<Waiting> choose(const Ordered &o, Value &into,
                       std::initializer_list<std::pair<std::string_view, Value>> names) {
    const auto value = one_of<Value>(o.words.empty() ? "" : o.words[0], names);
    if (!value.has_value()) {
        return std::unexpected(value.error());
    }
    into = *value;
    return done();
}

Result<Waiting> enable(const Ordered &o) {
    const std::string word = o.words.empty() ? "" : o.words[0];
    if (isSameWord(word, "OFF")) {
        o.own.isEnabled = false;
        return done();
    }
    o.own.isEnabled = false;
    if (word != o.settings.enable_password) {
        return fail("the password is wrong");
    }
    auto connected = o.commander.connect();
    if (!connected.has_value()) {
        return std::unexpected(connected.error());
    }
    o.own.isEnabled = true;
    return done();
}

Result<Waiting> disable(const Ordered &o) {
    o.own.isEnabled = false;
    return done();
}

Result<Waiting> set_length_unit(const Ordered &o) {
    return choose<LengthUnit>(o, o.own.length_unit,
                              {{"AUTO", LengthUnit::AUTO},
                               {"INCH", LengthUnit::INCH},
                               {"MM", LengthUnit::MM},
                               {"CM", LengthUnit::CM},
                               {"CUSTOM", LengthUnit::CUSTOM}});
}

Result<Waiting> set_angle_unit(const Ordered &o) {
    return choose<AngleUnit>(o, o.own.angle_unit,
                             {{"AUTO", AngleUnit::AUTO},
                              {"DEG", AngleUnit::DEG},
                              {"RAD", AngleUnit::RAD},
                              {"GRAD", AngleUnit::GRAD},
                              {"CUSTOM", AngleUnit::CUSTOM}});
}

Result<Waiting> set_wait_mode(const Ordered &o) {
    return choose<bool>(o, o.own.waiting_for_done, {{"DONE", true}, {"RECEIVED", false}});
}

Result<Waiting> wait_for_last(const Ordered &o) {
    bool is_done = true;
    auto chosen = choose<bool>(o, is_done, {{"DONE", true}, {"RECEIVED", false}});
    if (chosen.has_value()) {
        chosen->until = is_done ? Until::WHATEVER : Until::WHATEVER_TAKEN;
        chosen->serials = o.commander.last();
    }
    return chosen;
}

Result<Waiting> set_update(const Ordered &o) {
    auto chosen = choose<bool>(o, o.own.updating, {{"AUTO", true}, {"NONE", false}});
    if (chosen.has_value()) {
        o.own.kept = o.own.updating ? nullptr : std::make_unique<messages::MachineStatus>(o.status());
    }
    return chosen;
}

Result<Waiting> update_status(const Ordered &o) {
    if (o.own.kept != nullptr) {
        *o.own.kept = o.status();
    }
    return done();
}

Result<Waiting> set_timeout(const Ordered &o) {
    const auto seconds = number(o.words.empty() ? "" : o.words[0], "timeout");
    if (!seconds.has_value()) {
        return std::unexpected(seconds.error());
    }
    o.own.timeout_s = std::max(0.0, *seconds);
    return done();
}

Result<Waiting> set_protocol(const Ordered &o) {
    const std::string word = o.words.empty() ? "" : o.words[0];
    if (word != "1.0" && word != "1.1") {
        return no_such_value(word, "1.0, 1.1");
    }
    o.own.protocol = word;
    return done();
}

Result<Waiting> set_comm_mode(const Ordered &o) {
    bool is_text = true;
    return choose<bool>(o, is_text, {{"ASCII", true}});
}

/// Waits for this number of task cycles.
Result<Waiting> wait_heartbeat(const Ordered &o) {
    constexpr double LONGEST_S = 1;
    const auto periods = number(o.words.empty() ? "1" : o.words[0], "periods");
    if (!periods.has_value() || *periods < 0) {
        return no_such_value(o.words[0], "a number of periods");
    }
    const double seconds = *periods * o.settings.task_period_s;
    const double longest = o.own.timeout_s > 0 ? o.own.timeout_s : LONGEST_S;
    if (seconds > longest) {
        return fail(
            fmt::format("Invalid periods '{}', waiting time of {:.3f} seconds would exceed timeout of "
                        "{:.3f} seconds",
                        o.words[0], seconds, longest));
    }
    Waiting waiting;
    const std::uint64_t end = o.status().cycle + static_cast<std::uint64_t>(*periods);
    waiting.isOver = [end](const messages::MachineStatus &status) -> Result<bool> {
        return status.cycle >= end;
    };
    return waiting;
}

constexpr SpokenBy BOTH = SpokenBy::BOTH, NEWER = SpokenBy::NEWER, OLD = SpokenBy::OLD;

/// In alphabetical order, as HELP lists them. Stops are possible while the machine is off.
constexpr Row ROWS[] = {
    {BOTH, {"ABORT", Needs::ENABLE, "", abort_all}},
    {BOTH,
     {"ANGULAR_UNIT_CONVERSION", Needs::MACHINE_ON, "<Deg | Rad | Grad | Auto | Custom>", set_angle_unit}},
    {BOTH, {"BRAKE", Needs::MACHINE_ON, "<On | Off> [spindle]", set_brake}},
    {OLD, {"COMM_MODE", Needs::HELLO, "<Ascii>", set_comm_mode}},
    {OLD, {"COMM_PROT", Needs::HELLO, "<version>", set_protocol}},
    {BOTH, {"DEBUG", Needs::ENABLE, "<bits>", set_debug}},
    {NEWER, {"DISABLE", Needs::HELLO, "", disable}},
    {BOTH, {"ECHO", Needs::HELLO, "<On | Off>", switch_own<&OwnState::isEchoing>}},
    {BOTH, {"ENABLE", Needs::HELLO, "<password | Off>", enable}},
    {BOTH, {"ESTOP", Needs::ENABLE, "<On | Off>", set_estop}},
    {BOTH, {"FEED_OVERRIDE", Needs::MACHINE_ON, "<percent>", set_feed_override}},
    {BOTH, {"FLOOD", Needs::MACHINE_ON, "<On | Off>", set_flood}},
    {BOTH, {"HOME", Needs::MACHINE_ON, "<joint | -1>", home}},
    {BOTH, {"JOG", Needs::MACHINE_ON, "<joint | axis> <speed>", jog}},
    {BOTH, {"JOG_INCR", Needs::MACHINE_ON, "<joint | axis> <speed> <distance>", jog_increment}},
    {BOTH, {"JOG_STOP", Needs::ENABLE, "<joint | axis>", jog_stop}},
    {NEWER, {"JOINT_HOME", Needs::MACHINE_ON, "<joint | -1>", home}},
    {NEWER, {"JOINT_UNHOME", Needs::MACHINE_ON, "<joint | -1>", unhome}},
    {NEWER, {"JOINT_WAIT_HOMED", Needs::MACHINE_ON, "<joint | -1>", wait_homed}},
    {BOTH,
     {"LINEAR_UNIT_CONVERSION", Needs::MACHINE_ON, "<Inch | CM | MM | Auto | Custom>", set_length_unit}},
    {BOTH, {"LOAD_TOOL_TABLE", Needs::MACHINE_ON, "[file]", load_tool_table}},
    {BOTH, {"LUBE", Needs::MACHINE_ON, "<On | Off>", set_lube}},
    {BOTH, {"MACHINE", Needs::ENABLE, "<On | Off>", set_machine}},
    {BOTH, {"MDI", Needs::MACHINE_ON, "<line>", mdi}},
    {BOTH, {"MIST", Needs::MACHINE_ON, "<On | Off>", set_mist}},
    {BOTH, {"MODE", Needs::MACHINE_ON, "<Manual | Auto | MDI>", set_mode}},
    {BOTH, {"OPEN", Needs::MACHINE_ON, "<file>", open_program}},
    {BOTH, {"OPTIONAL_STOP", Needs::MACHINE_ON, "<none | 0 | 1>", set_optional_stop}},
    {BOTH, {"OVERRIDE_LIMITS", Needs::MACHINE_ON, "<On | Off>", override_limits}},
    {BOTH, {"PAUSE", Needs::MACHINE_ON, "", pause}},
    {BOTH, {"PROBE", Needs::MACHINE_ON, "<x> <y> <z>", probe}},
    {BOTH, {"PROBE_CLEAR", Needs::MACHINE_ON, "", clear_probe}},
    {BOTH, {"RESUME", Needs::MACHINE_ON, "", resume}},
    {BOTH, {"RUN", Needs::MACHINE_ON, "[line]", run}},
    {OLD, {"SET_WAIT", Needs::ENABLE, "<Received | Done>", set_wait_mode}},
    {BOTH,
     {"SPINDLE", Needs::MACHINE_ON, "<Forward | Reverse | Increase | Decrease | Constant | Off> [spindle]",
      set_spindle}},
    {BOTH, {"SPINDLE_OVERRIDE", Needs::MACHINE_ON, "[spindle] <percent>", set_spindle_override}},
    {BOTH, {"STEP", Needs::MACHINE_ON, "", step}},
    {BOTH, {"TASK_PLAN_INIT", Needs::MACHINE_ON, "", reset_interpreter}},
    {BOTH, {"TELEOP_ENABLE", Needs::MACHINE_ON, "<On | Off>", set_teleop}},
    {BOTH, {"TIMEOUT", Needs::ENABLE, "<seconds>", set_timeout}},
    {NEWER, {"TIMESTAMP", Needs::NOTHING, "<On | Off>", switch_own<&OwnState::isTimed>}},
    {BOTH, {"TOOL_OFFSET", Needs::MACHINE_ON, "<tool> <length> <diameter>", set_tool_offset}},
    {BOTH, {"UPDATE", Needs::ENABLE, "<None | Auto>", set_update}},
    {NEWER, {"UPDATE_STATUS", Needs::ENABLE, "", update_status}},
    {BOTH, {"VERBOSE", Needs::HELLO, "<On | Off>", switch_own<&OwnState::isVerbose>}},
    {BOTH, {"WAIT", Needs::ENABLE, "<Received | Done>", wait_for_last}},
    {NEWER, {"WAIT_HEARTBEAT", Needs::MACHINE_ON, "[periods]", wait_heartbeat}},
    {NEWER, {"WAIT_MODE", Needs::ENABLE, "<Received | Done>", set_wait_mode}},
};

bool isSpoken(const Row &row, const Settings &settings) {
    return row.dialect != (settings.isOld() ? NEWER : OLD);
}

}  // namespace

const Order *find_order(const Settings &settings, const std::string &name) {
    for (const Row &row : ROWS) {
        if (row.order.name == name && isSpoken(row, settings)) {
            return &row.order;
        }
    }
    return nullptr;
}

std::vector<std::string> order_usages(const Settings &settings) {
    std::vector<std::string> usages;
    for (const Row &row : ROWS) {
        if (isSpoken(row, settings)) {
            const std::string words = row.order.usage;
            usages.push_back(row.order.name + (words.empty() ? words : ' ' + words));
        }
    }
    return usages;
}

}  // namespace mw::rsh
