// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/executor.hh"

#include "gcode/interpreter/codes/comments.hh"
#include "gcode/interpreter/codes/moves/moves.hh"

namespace mw::gcode::detail {
namespace {

BlockCodes codes_of(const BlockValues &values) {
    BlockCodes out;
    for (const ActiveCode &active : values.codes) {
        const GCode code = active.code->id;
        switch (active.code->group) {
        case Group::DWELL:
        case Group::NON_MODAL:
            // LinuxCNC shows G92.1 to G92.3 only by their effect.
            out.non_modal = code > G(92) && code <= G(92, 3) ? -1 : number_of(code);
            break;
        case Group::STOP: out.stop = number_of(code); break;
        case Group::TOOL_CHANGE: out.tool_change = number_of(code); break;
        default: break;
        }
    }
    return out;
}

/// True for a block that is empty or only a straight move; such a block fails before it changes anything.
bool isStateSafe(const BlockValues &values, const State &state) {
    const bool straight = values.codes.size() == 1 && values.motion != nullptr && values.motion->id <= G(1) &&
                          !state.comp.isOn();
    return values.codes.empty() || straight;
}

bool isIniName(std::string_view name) {
    return name.starts_with("_ini[");
}

bool isHalName(std::string_view name) {
    return name.starts_with("_hal[");
}

}  // namespace

Executor::Executor(World &world, ToolSource &tool_source, ParameterSource &source, const Settings &settings,
                   Names &names)
    : tools(tool_source), script_levels{settings.debug_mask, settings.logging_level},
      parts{world,       settings, block_place,    canon,   parameters, tools,
            saved_modes, lathe,    control_points, awaited, fanuc_call},
      source_(source), names_(names), evaluator_(parameters, names, *this, fault), block_(fault) {
    modes.rotary = settings.rotary;
}

// ------------------------------------------------------------------------------------------- one block

bool Executor::run(const BlockView &view, std::string_view line_text) {
    BlockValues &values = block_.values;
    values.clear();
    block_codes = {};
    outcome = Outcome::OK;
    if (!read_words(view, {evaluator_, remaps}, values) ||
        (view.block->setting_count > 0 && !settings_.apply(view, evaluator_, names_, parameters, fault))) {
        return false;
    }
    block_.comment.clear();
    block_.number = view.block->isNumbered ? view.block->sequence : -1;
    if (lathe.request() != nullptr) {
        keep_state();
        return lathe.record(values, parts.settings, modes);
    }
    if (view.block->comment_count > 0 && !run_last_comment(view, line_text)) {
        return false;
    }
    if (view.block->word_count == 0) {
        return true;  // only settings and comments, as in most lines of loops
    }
    if (!choose_motion(values, modes.motion, remaps) || !check_machine_coordinates(values) ||
        !check_open_nurbs(values, modes) || !axis_check_.check(values, parts.world.axis_mask()) ||
        !check_words(values) || !check_rotary(values, modes)) {
        return false;
    }
    block_codes = codes_of(values);
    return run_codes(values, 0);
}

/// Runs only the last comment of a block.
bool Executor::run_last_comment(const BlockView &view, std::string_view line_text) {
    const Comment &last = view.arena->comments[view.block->first_comment + view.block->comment_count - 1u];
    const std::string_view comment = line_text.substr(last.begin, last.end - last.begin);
    if (last.is_script) {
        block_.script_text = comment;
        outcome = Outcome::SCRIPT;
        return true;
    }
    if (!remaps.all().empty()) {
        block_.comment = comment;
    }
    return run_comment(comment, last.begin + 1, {evaluator_, names_}, canon, fault);
}

/// Runs the codes from `first` on. A remapped code interrupts the block; the rest runs after its procedure.
bool Executor::run_codes(const BlockValues &values, std::size_t first) {
    if (!isStateSafe(values, modes)) {
        keep_state();
    }
    for (std::size_t i = first; i < values.codes.size(); ++i) {
        const ActiveCode &active = values.codes[i];
        if (active.code->remap != nullptr) {
            remaps.interrupt(
                {active.code->remap, values, i + 1, block_.comment, block_place.line, block_.number});
            outcome = Outcome::REMAP;
            return true;
        }
        const Effect effect = active.code->run(active.code->id, values, modes, parts);
        if (!effect) {
            if (fault.column == 0) {
                fault.column = active.column;
            }
            return false;
        }
        if (effect.next != Outcome::OK) {
            outcome = effect.next;
        }
        if (remaps.isAnyRunning()) {
            remaps.count_builtin(active.code->id);
        }
    }
    return true;
}

bool Executor::resume(const PendingBlock &pending) {
    begin_block();
    block_.comment = pending.comment;
    return run_codes(pending.values, pending.next);
}

// ------------------------------------------------------------------------------------------------ undo

void Executor::begin_block() {
    begin_light_block();
    keep_state();
}

void Executor::begin_light_block() {
    state_kept_ = false;
    codes_before_ = block_codes;
    canon.begin_undo();
    outcome = Outcome::OK;
}

/// The modes are large, so they are copied only for blocks that change them.
void Executor::keep_state() {
    if (!state_kept_) {
        before_ = modes;
        state_kept_ = true;
    }
}

void Executor::commit() {
    parameters.commit();
    tools.commit();
    saved_modes.commit();
    canon.commit();
}

void Executor::rollback() {
    if (state_kept_) {
        modes = before_;
    }
    block_codes = codes_before_;
    parameters.rollback();
    tools.rollback();
    saved_modes.rollback();
    remaps.drop_interrupted();
    canon.rollback();
    outcome = Outcome::OK;
}

void Executor::flush(Canon &target) {
    if (!modes.comp.isHolding()) {
        canon.flush(target);
        return;
    }
    canon.flush(target, modes.comp.held_call());
    modes.comp.set_held_call(0);
    before_.comp.set_held_call(0);
}

void Executor::abort_block() {
    remaps.drop_interrupted();
    outcome = Outcome::OK;
    awaited.isProbe = awaited.is_input = false;
    modes.spline.order = 0;
    state_kept_ = false;
    canon.clear();
    modes.comp.forget_move();
    lathe.forget_roughing();
}

// ------------------------------------------------------------------------------------- calls, the machine

void Executor::push_call() {
    parameters.push_call();
    saved_modes.push_call();
}

/// Fanuc-style calls have no arguments: #1 to #30 belong to the caller.
bool Executor::pop_call(bool is_fanuc) {
    const std::optional<State> saved = saved_modes.pop_call();
    parameters.pop_call(is_fanuc);
    remaps.end_above(saved_modes.depth());
    if (!saved) {
        return true;
    }
    keep_state();
    return restore_modes(*saved, modes, parts, fault);
}

void Executor::drop_calls(std::size_t depth) {
    for (std::size_t calls = saved_modes.depth(); calls > depth; --calls) {
        parameters.pop_call(false);
    }
    saved_modes.drop_calls(depth);
    remaps.end_above(depth);
    if (depth == 0) {
        lathe.drop();
    }
}

void Executor::restore(const InterpreterState &kept) {
    static_cast<InterpreterState &>(*this) = kept;
    tools.forget();
    awaited = {};
}

// --------------------------------------------------------------------- values that programs and scripts read

AttributeSources Executor::attribute_sources() {
    return {modes, returned, script_levels, parts, remaps.count_running()};
}

KeptSources Executor::kept_sources() const {
    return {modes, returned, parts, modes.comp.compensated(modes.position, modes.plane),
            remaps.count_running()};
}

bool Executor::isBuiltInName(std::string_view name) const {
    if (script_names_ != nullptr && script_names_->hasName(name)) {
        return true;
    }
    return isIniName(name) || isHalName(name) || isKeptName(name);
}

std::optional<double> Executor::built_in(std::string_view name) const {
    if (script_names_ != nullptr && script_names_->hasName(name)) {
        return script_names_->value_of(name);
    }
    if (isIniName(name)) {
        const std::size_t close = name.find(']');
        if (close == std::string_view::npos || !parts.settings.ini_readable) {
            return std::nullopt;
        }
        const auto value = source_.ini_value(name.substr(5, close - 5), name.substr(close + 1));
        if (value && !ini_names_read_.contains(name)) {
            ini_names_read_.emplace(name);
        }
        return value;
    }
    if (isHalName(name)) {
        if (!parts.settings.hal_readable) {
            return std::nullopt;
        }
        return source_.hal_value(name.substr(5, name.find(']') - 5));
    }
    return kept_value(name, kept_sources());
}

double Executor::built_in(int number) const {
    return kept_value(number, kept_sources());
}

}  // namespace mw::gcode::detail
