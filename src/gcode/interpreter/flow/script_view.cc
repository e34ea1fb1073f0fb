// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/script_view.hh"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "base/text.hh"
#include "gcode/interpreter/flow/script_calls.hh"

namespace mw::gcode::detail {
namespace {

/// Modal groups in the manual's numbering; -1 for groups without a number.
int group_number(Group group) {
    switch (group) {
    case Group::DWELL:
    case Group::NON_MODAL: return 0;
    case Group::MOTION: return 1;
    case Group::PLANE: return 2;
    case Group::DISTANCE: return 3;
    case Group::CENTRE_DISTANCE: return 4;
    case Group::FEED_MODE: return 5;
    case Group::UNITS: return 6;
    case Group::COMP: return 7;
    case Group::TOOL_OFFSET: return 8;
    case Group::RETRACT: return 10;
    case Group::COORDINATES: return 12;
    case Group::CONTROL: return 13;
    case Group::SPINDLE_MODE: return 14;
    case Group::DIAMETER: return 15;
    case Group::STOP: return 4;
    case Group::IO: return 5;
    case Group::TOOL_CHANGE: return 6;
    case Group::SPINDLE: return 7;
    case Group::COOLANT: return 8;
    case Group::OVERRIDE: return 9;
    case Group::USER:
    case Group::CONTEXT: return 10;
    case Group::WORD_F:
    case Group::WORD_S:
    case Group::WORD_T: break;
    }
    return -1;
}

/// The name in lower case without blanks; INI and HAL names are not changed.
std::string folded(std::string_view name) {
    return name.find('[') == std::string_view::npos ? to_lower(name) : std::string(name);
}

constexpr std::string_view CALL_LEVEL = "call_level", STACK_INDEX = "stack_index", FILE_NAME = "filename",
                           LINE_TEXT = "linetext", PERCENT = "percent_flag", ERROR_TEXT = "errormsg";

}  // namespace

std::expected<bool, ScriptFault> ScriptView::execute(std::string_view text, int line) {
    return execute_(text, line);
}

Canon &ScriptView::canon() {
    return executor_.canon;
}

void ScriptView::deliver() {
    settle_script(parts_);
}

// ------------------------------------------------------------------------------------------ parameters

double ScriptView::parameter(int number) const {
    return number >= 1 && number < PARAMETER_COUNT ? executor_.evaluator().numbered(number) : 0.0;
}

Result<> ScriptView::set_parameter(int number, double value) {
    if (number < 1 || number >= PARAMETER_COUNT) {
        return fail(fmt::format("params subscript out of range : {} - must be between 1 and {}", number,
                                PARAMETER_COUNT - 1));
    }
    executor_.parameters.set(number, value);
    executor_.parameters.commit();
    return {};
}

std::optional<double> ScriptView::named(std::string_view name) {
    return executor_.evaluator().named(parts_.names.intern(folded(name)));
}

Result<> ScriptView::set_named(std::string_view name, double value) {
    const NameId id = parts_.names.intern(folded(name));
    if (name.empty() || executor_.evaluator().isReadOnly(id)) {
        return fail(fmt::format("can't assign value to parameter: {}", name));
    }
    executor_.parameters.set_named(id, executor_.evaluator().isGlobal(id), value);
    executor_.parameters.commit();
    return {};
}

std::vector<std::string> ScriptView::local_names() const {
    std::vector<std::string> out;
    for (const auto &[id, value] : executor_.parameters.locals(executor_.parameters.depth() - 1)) {
        out.push_back(parts_.names.text(id));
    }
    std::ranges::sort(out);
    return out;
}

std::vector<std::string> ScriptView::predefined_names() const {
    std::vector<std::string> out = kept_names();
    out.insert(out.end(), parts_.scripts.names().begin(), parts_.scripts.names().end());
    std::ranges::sort(out);
    out.erase(std::ranges::unique(out).begin(), out.end());
    return out;
}

std::vector<std::string> ScriptView::script_names() const {
    return parts_.scripts.names();
}

/// Includes the names of the main program and the INI values that were read.
std::vector<std::string> ScriptView::global_names() const {
    std::vector<std::string> out = predefined_names();
    for (const auto &[id, value] : executor_.parameters.globals()) {
        out.push_back(parts_.names.text(id));
    }
    for (const auto &[id, value] : executor_.parameters.locals(0)) {
        out.push_back(parts_.names.text(id));
    }
    const std::set<std::string, std::less<>> &ini = executor_.ini_names_read();
    out.insert(out.end(), ini.begin(), ini.end());
    std::ranges::sort(out);
    out.erase(std::ranges::unique(out).begin(), out.end());
    return out;
}

// --------------------------------------------------------------------------------------------- state

std::optional<ScriptValue> ScriptView::attribute(std::string_view name) const {
    if (name == CALL_LEVEL) {
        return static_cast<std::int64_t>(parts_.levels.call_level());
    }
    if (name == STACK_INDEX) {
        return static_cast<std::int64_t>(parts_.levels.size());
    }
    if (name == FILE_NAME) {
        return parts_.levels.file();
    }
    if (name == LINE_TEXT) {
        return parts_.levels.line_text();
    }
    if (name == PERCENT) {
        const Program *const program = parts_.levels.here().program;
        return program != nullptr && program->isPercentDelimited();
    }
    if (name == ERROR_TEXT) {
        return parts_.scripts.error_text;
    }
    return detail::attribute(name, executor_.attribute_sources());
}

Result<> ScriptView::set_attribute(std::string_view name, const ScriptValue &value) {
    if (name == ERROR_TEXT && std::holds_alternative<std::string>(value)) {
        parts_.scripts.error_text = std::get<std::string>(value);
        return {};
    }
    return detail::set_attribute(name, value, executor_.attribute_sources());
}

std::vector<std::string_view> ScriptView::attribute_names() const {
    std::vector<std::string_view> out = detail::attribute_names();
    out.insert(out.end(), {CALL_LEVEL, STACK_INDEX, FILE_NAME, LINE_TEXT, PERCENT});
    return out;
}

/// The entry at 0 is the tool in the spindle, number -1 when empty.
ToolEntry ScriptView::tool(int index) const {
    if (index != 0 || executor_.tools.isRandom()) {
        return executor_.tools.entry(index);
    }
    const State &state = executor_.modes;
    if (state.tool.in_spindle == 0) {
        ToolEntry none;
        none.toolno = -1;
        return none;
    }
    const int place = executor_.tools.index_of_tool(state.tool.in_spindle);
    if (place > 0) {
        return executor_.tools.entry(place);
    }
    ToolEntry entry;
    entry.toolno = state.tool.in_spindle;
    entry.offset = state.tool.offset;
    entry.diameter = state.tool.diameter;
    entry.frontangle = state.tool.frontangle;
    entry.backangle = state.tool.backangle;
    entry.orientation = state.tool.orientation;
    return entry;
}

double ScriptView::spindle_speed(int spindle) const {
    return executor_.modes.spindles[static_cast<std::size_t>(spindle)].speed;
}

void ScriptView::set_spindle_speed(int spindle, double speed) {
    executor_.modes.spindles[static_cast<std::size_t>(spindle)].speed = speed;
}

// ------------------------------------------------------------------------------- blocks and levels of call

ScriptBlock ScriptView::remap_block(const ScriptCall &call, int level) const {
    ScriptBlock out;
    const PendingBlock &pending = *call.pending;
    out.g_modes.fill(-1);
    out.m_modes.fill(-1);
    for (std::size_t i = 0; i < out.value.size(); ++i) {
        if ((pending.values.present & bit_of(static_cast<int>(i))) != 0) {
            out.present |= bit_of(static_cast<int>(i));
            out.value[i] = pending.values.value[i];
        }
    }
    if (pending.values.has('@')) {
        out.radius = pending.values.at('@');
    }
    if (pending.values.has('^')) {
        out.angle = pending.values.at('^');
    }
    for (const ActiveCode &active : pending.values.codes) {
        const int group = group_number(active.code->group);
        if (group < 0 || (pending.values.motion_implied && active.code == pending.values.motion)) {
            continue;
        }
        if (letter_of(active.code->id) == 'g') {
            out.g_modes[static_cast<std::size_t>(group)] = number_of(active.code->id);
        } else {
            out.m_modes[static_cast<std::size_t>(group)] = number_of(active.code->id);
            ++out.m_count;
        }
    }
    out.motion = pending.values.motion != nullptr ? number_of(pending.values.motion->id) : -1;
    out.line = pending.line;
    out.number = pending.sequence;
    out.comment = pending.comment;
    out.builtins = executor_.remaps.builtin_uses(level);
    out.remap = pending.remap->described();
    return out;
}

ScriptBlock ScriptView::block(int level) const {
    int remaps = 0;
    for (const Call &call : parts_.levels.calls()) {
        if (call.kind == CallKind::REMAP && ++remaps == level) {
            return remap_block(*call.script, level);
        }
    }
    ScriptBlock out;
    out.g_modes.fill(-1);
    out.m_modes.fill(-1);
    out.line = parts_.levels.here().line;
    if (level != 0) {
        return out;
    }
    out.params.assign(ARGUMENT_COUNT, 0.0);
    for (const Call &call : parts_.levels.calls()) {
        if (call.script != nullptr) {
            out.o_name = call_name(call, parts_.names);
            std::ranges::fill(out.params, 0.0);
            std::ranges::copy(call.script->arguments, out.params.begin());
        }
    }
    return out;
}

std::vector<ScriptContext> ScriptView::contexts() const {
    std::vector<ScriptContext> out(1);
    const auto fill = [this](ScriptContext &context, std::size_t level) {
        const bool is_main = level == 0;
        for (const auto &[id, value] : executor_.parameters.locals(static_cast<int>(level))) {
            context.named.emplace_back(parts_.names.text(id), value);
        }
        context.status = executor_.saved_modes.status(level);
        context.arguments = executor_.parameters.saved_arguments(static_cast<int>(level));
        context.saved = executor_.active_codes();
        if (is_main) {
            for (std::string &name : global_names()) {
                if (!name.starts_with('_')) {
                    continue;  // a global of a script, already in the list
                }
                const auto value = executor_.evaluator().named(parts_.names.intern(name));
                context.named.emplace_back(std::move(name), value.value_or(0.0));
            }
        }
        std::ranges::sort(context.named);
    };
    fill(out.front(), 0);
    out.front().file = parts_.levels.file();
    for (const Call &call : parts_.levels.calls()) {
        if (call.kind == CallKind::TEXT) {
            continue;
        }
        ScriptContext &context = out.emplace_back();
        constexpr int PROCEDURE = 1, FANUC = 2, SCRIPT = 3, REMAP = 4, REMAP_STATUS = 4;
        const bool is_remap = call.kind == CallKind::REMAP;
        context.kind = is_remap                        ? REMAP
                       : call.kind == CallKind::SCRIPT ? SCRIPT
                       : call.kind == CallKind::FANUC  ? FANUC
                                                       : PROCEDURE;
        context.name = call_name(call, parts_.names);
        context.file = call.program != nullptr ? call.program->path() : std::string();
        context.line = call.line;
        fill(context, out.size() - 1);
        context.status |= is_remap ? REMAP_STATUS : 0;
    }
    return out;
}

}  // namespace mw::gcode::detail
