// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/codes/executor.hh"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "interp/codes/comments.hh"

namespace mw::interp::detail {
namespace {

constexpr char LETTERS[] = "abcdefghijklmnopqrstuvwxyz@^$";
constexpr double CODE_TOLERANCE = 1e-4;
constexpr double MM_PER_INCH = 25.4;

}  // namespace

Executor::Executor(World &world, ToolSource &tools, ParameterSource &source, const Settings &settings,
                   Names &names)
    : script_levels{settings.debug_mask, settings.logging_level}, world_(world), tools_(tools),
      source_(source), settings_(settings), names_(names), evaluator_(parameters, names, *this, fault),
      tool_table_(tools) {}

std::string Executor::code_name(const Code &code) const {
    if (code.letter == 'g') {
        return code.number % 10 == 0 ? fmt::format("g{}", code.number / 10)
                                     : fmt::format("g{}.{}", code.number / 10, code.number % 10);
    }
    return fmt::format("{}{}", code.letter, code.number);
}

double Executor::machine_to_program() const {
    const double mm = world_.mm_per_machine_unit();
    return state.units == LengthUnits::MM ? mm : mm / MM_PER_INCH;
}

// ------------------------------------------------------------------------------------------- one block

bool Executor::run(const BlockView &view, std::string_view line_text) {
    BlockValues &values = values_;
    values.clear();
    outcome = Outcome::OK;
    if (!evaluate(view, values) || !apply_settings(view)) {
        return false;
    }
    comment_.clear();
    block_number_ = view.block->isNumbered ? view.block->sequence : -1;
    if (lathe_) {
        keep_state();
        return record_profile(values);
    }
    if (view.block->comment_count > 0 && !run_last_comment(view, line_text)) {
        return false;
    }
    if (!choose_motion(values) || !check_words(values)) {
        return false;
    }
    return run_codes(values, 0);
}

/// Only the last comment of a block counts.
bool Executor::run_last_comment(const BlockView &view, std::string_view line_text) {
    const Comment &last = view.arena->comments[view.block->first_comment + view.block->comment_count - 1u];
    const std::string_view comment = line_text.substr(last.begin, last.end - last.begin);
    if (last.isScript) {
        script_text_ = comment;
        outcome = Outcome::SCRIPT;
        return true;
    }
    if (!remaps.all().empty()) {
        comment_ = comment;
    }
    return run_comment(comment, last.begin + 1, {evaluator_, names_}, canon, fault);
}

/// Nothing, or a straight move alone, which fails before it changes anything.
bool Executor::isStateSafe(const BlockValues &values) const {
    constexpr int G1 = 10;
    const bool isStraight = values.codes.size() == 1 && values.motion != nullptr &&
                            values.motion->number <= G1 && state.comp == CompSide::OFF;
    return values.codes.empty() || isStraight;
}

/// The codes from `first` on; stops at a remapped one.
bool Executor::run_codes(const BlockValues &values, std::size_t first) {
    if (!isStateSafe(values)) {
        keep_state();
    }
    for (std::size_t i = first; i < values.codes.size(); ++i) {
        const ActiveCode &active = values.codes[i];
        if (active.code->remap != nullptr) {
            return stop_at_remap(values, i);
        }
        if (!(this->*active.code->handler)(*active.code, values)) {
            if (fault.column == 0) {
                fault.column = active.column;
            }
            return false;
        }
        if (remaps.isAnyRunning()) {
            remaps.count_builtin(*active.code);
        }
    }
    return true;
}

bool Executor::evaluate(const BlockView &view, BlockValues &values) {
    const Arena &arena = *view.arena;
    const Block &block = *view.block;
    for (std::uint32_t i = 0; i < block.word_count; ++i) {
        const Word &word = arena.words[block.first_word + i];
        double value = word.value;
        if (word.expression != NO_ID && !evaluator_.value(arena, word.expression, value)) {
            return false;
        }
        const char letter_char = LETTERS[word.letter];
        if (letter_char == 'g' || letter_char == 'm') {
            if (!add_code(letter_char, value, word.column, values)) {
                return false;
            }
            continue;
        }
        values.present |= bit_of(word.letter);
        values.value[word.letter] = value;
        values.column[word.letter] = word.column;
        if (letter_char == 'f' || letter_char == 's' || letter_char == 't') {
            if (!insert_code(*lookup(letter_char, 0), word.column, values)) {
                return false;
            }
        }
    }
    return true;
}

bool Executor::add_code(char letter_char, double number, std::uint32_t column, BlockValues &values) {
    constexpr double MOST = 9999;
    const double scaled = letter_char == 'g' ? number * 10.0 : number;
    if (number < 0.0) {
        return fault.set(fmt::format("Negative {} code used", letter_char), column);
    }
    int whole = scaled <= MOST ? static_cast<int>(scaled) : -1;
    if (whole != scaled) {
        const double rounded = std::round(scaled);
        if (std::fabs(scaled - rounded) > CODE_TOLERANCE * 10 || rounded > MOST) {
            return fault.set(fmt::format("Unknown {} code used: {}{}", letter_char, letter_char, number),
                             column);
        }
        whole = static_cast<int>(rounded);
    }
    const Code *code = lookup(letter_char, whole);
    if (code == nullptr && remaps.isAnyRunning()) {
        if (std::string recursion = remaps.recursion_text(letter_char, whole); !recursion.empty()) {
            return fault.set(std::move(recursion), column);
        }
    }
    if (code == nullptr && letter_char == 'm' && whole > 199) {
        return fault.set(fmt::format("M-code greater than 199: M{}", whole), column);
    }
    if (code == nullptr) {
        return fault.set(
            fmt::format("Unknown {} code used: {}", letter_char, fmt::format("{}{}", letter_char, number)),
            column);
    }
    if (letter_char == 'g' && whole == 530) {
        values.isMachineCoordinates = true;
    }
    return insert_code(*code, column, values);
}

/// Keeps the codes in their order of execution; refuses two of one group.
bool Executor::insert_code(const Code &code, std::uint32_t column, BlockValues &values) {
    const std::uint32_t bit = 1u << static_cast<unsigned>(code.group);
    if (code.group == Group::MOTION && values.motion != nullptr) {
        // G80 beside another motion code says nothing that this one does not say.
        if (code.number == MOTION_NONE) {
            return true;
        }
        if (values.motion->number == MOTION_NONE && values.motion->phase == code.phase) {
            for (ActiveCode &active : values.codes) {
                active = active.code == values.motion ? ActiveCode{&code, column} : active;
            }
            values.motion = &code;
            return true;
        }
    }
    if ((values.groups & bit) != 0) {
        return fault.set(fmt::format("Two {} codes used from same modal group", code.letter), column);
    }
    values.groups |= bit;
    if (code.group == Group::MOTION) {
        values.motion = &code;
    }
    if (!values.codes.push_back({&code, column})) {
        return fault.set("Too many codes in one block", column);
    }
    for (std::size_t i = values.codes.size() - 1;
         i > 0 && values.codes[i].code->phase < values.codes[i - 1].code->phase; --i) {
        std::swap(values.codes[i], values.codes[i - 1]);
    }
    return true;
}

/// Axis words belong to a code of the block that uses them, else to the motion in force.
bool Executor::choose_motion(BlockValues &values) {
    const bool isCancelling = values.motion != nullptr && values.motion->number == MOTION_NONE;
    if ((values.motion != nullptr && !isCancelling) || !values.hasAxes()) {
        return true;
    }
    for (const ActiveCode &active : values.codes) {
        if (active.code->usesAxes) {
            return true;
        }
    }
    if (isCancelling) {
        return fault.set("Cannot use axis values with g80");
    }
    if (state.motion == MOTION_NONE) {
        return fault.set("Cannot use axis values without a g code that uses them");
    }
    values.isMotionImplied = true;
    return insert_code(*lookup('g', state.motion), 0, values);
}

/// The machine must have the axes that the block names.
bool Executor::check_axes(const BlockValues &values) {
    const unsigned mask = world_.axis_mask();
    if (mask != axis_mask_) {
        axis_mask_ = mask;
        absent_axes_ = 0;
        for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
            const bool isThere = (mask & (1U << static_cast<unsigned>(axis))) != 0;
            absent_axes_ |= isThere ? 0U : bit_of(letter(geom::AXIS_LETTERS_LOWER[axis]));
        }
    }
    const std::uint32_t absent = values.present & absent_axes_;
    if (absent == 0) {
        return true;
    }
    const int index = std::countr_zero(absent);
    const char axis = LETTERS[index];
    return fault.set(fmt::format("Bad character '{}' used", axis),
                     values.column[static_cast<std::size_t>(index)],
                     fmt::format("this machine has no axis {}: see [TRAJ]COORDINATES",
                                 static_cast<char>(std::toupper(axis))));
}

bool Executor::check_words(const BlockValues &values) {
    if (!check_open_nurbs(values) || !check_axes(values)) {
        return false;
    }
    constexpr std::uint32_t ALWAYS = letters("fstn");
    std::uint32_t allowed = ALWAYS;
    bool isAxisUser = false;
    for (const ActiveCode &active : values.codes) {
        const Code &code = *active.code;
        allowed |= code.words | (code.usesAxes ? AXES : 0);
        const std::uint32_t missing = code.required & ~values.present;
        if (missing != 0) {
            return fault.set(fmt::format("{} needs the word {}", code_name(code),
                                         static_cast<char>(std::toupper(LETTERS[std::countr_zero(missing)]))),
                             active.column);
        }
        if (code.usesAxes && values.hasAxes()) {
            if (isAxisUser) {
                return fault.set("Cannot use two g codes that both use axis values", active.column);
            }
            isAxisUser = true;
        }
    }
    const std::uint32_t unused = values.present & ~allowed;
    if (unused != 0) {
        const int index = std::countr_zero(unused);
        return fault.set(fmt::format("{} word with no g code that uses it",
                                     static_cast<char>(std::toupper(LETTERS[index]))),
                         values.column[static_cast<std::size_t>(index)]);
    }
    return true;
}

/// All values are computed before any is set.
bool Executor::apply_settings(const BlockView &view) {
    const Arena &arena = *view.arena;
    const Block &block = *view.block;
    if (block.setting_count == 0) {
        return true;
    }
    made_.clear();
    for (std::uint32_t i = 0; i < block.setting_count; ++i) {
        MadeSetting entry;
        if (!compute_setting(arena, arena.settings[block.first_setting + i], entry)) {
            return false;
        }
        made_.push_back(entry);
    }
    for (const MadeSetting &entry : made_) {
        if (entry.name != NO_ID) {
            parameters.set_named(entry.name, evaluator_.isGlobal(entry.name), entry.value);
        } else {
            parameters.set(entry.number, entry.value);
        }
    }
    return true;
}

bool Executor::compute_setting(const Arena &arena, const Setting &setting, MadeSetting &out) {
    out.name = setting.name;
    if (setting.name != NO_ID && evaluator_.isReadOnly(setting.name)) {
        return fault.set(fmt::format("Cannot assign to read-only parameter #<{}>", names_.text(setting.name)),
                         setting.column);
    }
    if (setting.name == NO_ID) {
        double index = 0;
        if (!evaluator_.value(arena, setting.index, index)) {
            return false;
        }
        if (!Evaluator::take_number(index, out.number)) {
            return fault.set("Parameter number out of range", setting.column,
                             fmt::format("{} is not in 1..{}", index, PARAMETER_COUNT - 1));
        }
        if (isBuiltInNumber(out.number)) {
            return fault.set(fmt::format("Parameter is readonly: #{}", out.number), setting.column);
        }
    }
    return evaluator_.value(arena, setting.value, out.value);
}

}  // namespace mw::interp::detail
