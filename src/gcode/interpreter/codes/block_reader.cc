// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/block_reader.hh"

#include <bit>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "base/geometry/pose.hh"
#include "gcode/interpreter/codes/block_values.hh"

namespace mw::gcode::detail {
namespace {

constexpr char LETTERS[] = "abcdefghijklmnopqrstuvwxyz@^$";
constexpr double CODE_TOLERANCE = 1e-4;

/// The row of a code: a remap, unless its own procedure runs, else the table row.
const Code *lookup(GCode code, const Remaps &remaps) {
    const Code *const remapped = remaps.find(code);
    return remapped != nullptr ? remapped : find_code(code);
}

/// Inserts the code in the order of execution; rejects two of one group.
bool insert_code(const Code &code, std::uint32_t column, BlockValues &values) {
    const std::uint32_t bit = 1u << static_cast<unsigned>(exclusive_group(code.group));
    if (code.group == Group::MOTION && values.motion != nullptr) {
        // A redundant G80 beside another motion code.
        if (code.id == MOTION_NONE) {
            return true;
        }
        if (values.motion->id == MOTION_NONE) {
            for (ActiveCode &active : values.codes) {
                active = active.code == values.motion ? ActiveCode{&code, column} : active;
            }
            values.motion = &code;
            return true;
        }
    }
    if ((values.groups & bit) != 0) {
        return values.fault->set(fmt::format("Two {} codes used from same modal group", letter_of(code.id)),
                                 column);
    }
    values.groups |= bit;
    if (code.group == Group::MOTION) {
        values.motion = &code;
    }
    if (!values.codes.push_back({&code, column})) {
        return values.fault->set("Too many codes in one block", column);
    }
    for (std::size_t i = values.codes.size() - 1;
         i > 0 && values.codes[i].code->group < values.codes[i - 1].code->group; --i) {
        std::swap(values.codes[i], values.codes[i - 1]);
    }
    return true;
}

bool add_code(char letter_char, double number, std::uint32_t column, const Remaps &remaps,
              BlockValues &values) {
    constexpr double MOST = 9999;
    const double scaled = letter_char == 'g' ? number * 10.0 : number;
    if (number < 0.0) {
        return values.fault->set(fmt::format("Negative {} code used", letter_char), column);
    }
    int whole = scaled <= MOST ? static_cast<int>(scaled) : -1;
    if (whole != scaled) {
        const double rounded = std::round(scaled);
        if (std::fabs(scaled - rounded) > CODE_TOLERANCE * 10 || rounded > MOST) {
            return values.fault->set(
                fmt::format("Unknown {} code used: {}{}", letter_char, letter_char, number), column);
        }
        whole = static_cast<int>(rounded);
    }
    const GCode id = make_code(letter_char, whole);
    const Code *code = lookup(id, remaps);
    if (code == nullptr && remaps.isAnyRunning()) {
        if (std::string recursion = remaps.recursion_text(id); !recursion.empty()) {
            return values.fault->set(std::move(recursion), column);
        }
    }
    if (code == nullptr && letter_char == 'm' && whole > 199) {
        return values.fault->set(fmt::format("M-code greater than 199: M{}", whole), column);
    }
    if (code == nullptr) {
        return values.fault->set(
            fmt::format("Unknown {} code used: {}", letter_char, fmt::format("{}{}", letter_char, number)),
            column);
    }
    if (id == G(53)) {
        values.is_machine_coordinates = true;
    }
    return insert_code(*code, column, values);
}

}  // namespace

bool read_words(const BlockView &view, const BlockSources &sources, BlockValues &values) {
    const Arena &arena = *view.arena;
    const Block &block = *view.block;
    for (std::uint32_t i = 0; i < block.word_count; ++i) {
        const Word &word = arena.words[block.first_word + i];
        double value = word.value;
        if (word.expression != NO_ID && !sources.evaluator.value(arena, word.expression, value)) {
            return false;
        }
        const char letter_char = LETTERS[word.letter];
        if (letter_char == 'g' || letter_char == 'm') {
            if (!add_code(letter_char, value, word.column, sources.remaps, values)) {
                return false;
            }
            continue;
        }
        values.present |= bit_of(word.letter);
        values.value[word.letter] = value;
        values.column[word.letter] = word.column;
        if (letter_char == 'f' || letter_char == 's' || letter_char == 't') {
            if (!insert_code(*lookup(word_code(letter_char), sources.remaps), word.column, values)) {
                return false;
            }
        }
    }
    return true;
}

bool choose_motion(BlockValues &values, GCode motion, const Remaps &remaps) {
    const bool cancelling = values.motion != nullptr && values.motion->id == MOTION_NONE;
    if ((values.motion != nullptr && !cancelling) || !values.hasAxes()) {
        return true;
    }
    for (const ActiveCode &active : values.codes) {
        if (active.code->usesAxes) {
            return true;
        }
    }
    if (cancelling) {
        return values.fault->set("Cannot use axis values with g80");
    }
    const Code *const implied = motion == MOTION_NONE ? nullptr : lookup(motion, remaps);
    if (implied == nullptr) {  // a script may set any motion mode
        return values.fault->set("Cannot use axis values without a g code that uses them");
    }
    values.motion_implied = true;
    return insert_code(*implied, 0, values);
}

bool check_machine_coordinates(const BlockValues &values) {
    const GCode motion = values.motion != nullptr ? values.motion->id : MOTION_NONE;
    return !values.is_machine_coordinates || motion == G(0) || motion == G(1) ||
           values.fault->set("Must use g0 or g1 with g53");
}

bool check_words(const BlockValues &values) {
    constexpr std::uint32_t ALWAYS = letters("fstn");
    std::uint32_t allowed = ALWAYS;
    bool is_axis_user = false;
    for (const ActiveCode &active : values.codes) {
        const Code &code = *active.code;
        allowed |= code.words | (code.usesAxes ? AXES : 0);
        const std::uint32_t missing = code.required & ~values.present;
        if (missing != 0) {
            return values.fault->set(
                fmt::format("{} needs the word {}", code_name(code.id),
                            static_cast<char>(std::toupper(LETTERS[std::countr_zero(missing)]))),
                active.column);
        }
        if (code.usesAxes && values.hasAxes()) {
            if (is_axis_user) {
                return values.fault->set("Cannot use two g codes that both use axis values", active.column);
            }
            is_axis_user = true;
        }
    }
    const std::uint32_t unused = values.present & ~allowed;
    if (unused != 0) {
        const int index = std::countr_zero(unused);
        return values.fault->set(fmt::format("{} word with no g code that uses it",
                                             static_cast<char>(std::toupper(LETTERS[index]))),
                                 values.column[static_cast<std::size_t>(index)]);
    }
    return true;
}

bool AxisCheck::check(const BlockValues &values, unsigned mask) {
    if (mask != mask_) {
        mask_ = mask;
        absent_ = 0;
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const bool present = (mask & (1U << static_cast<unsigned>(axis))) != 0;
            absent_ |= present ? 0U : bit_of(letter(geometry::AXIS_LETTERS_LOWER[axis]));
        }
    }
    const std::uint32_t absent = values.present & absent_;
    if (absent == 0) {
        return true;
    }
    const int index = std::countr_zero(absent);
    const char axis = LETTERS[index];
    return values.fault->set(fmt::format("Bad character '{}' used", axis),
                             values.column[static_cast<std::size_t>(index)],
                             fmt::format("this machine has no axis {}: check [TRAJ]COORDINATES",
                                         static_cast<char>(std::toupper(axis))));
}

bool BlockSettings::apply(const BlockView &view, const Evaluator &evaluator, const Names &names,
                          Parameters &parameters, Fault &fault) {
    const Arena &arena = *view.arena;
    const Block &block = *view.block;
    if (block.setting_count == 0) {
        return true;
    }
    made_.clear();
    for (std::uint32_t i = 0; i < block.setting_count; ++i) {
        MadeSetting entry;
        if (!compute_setting(arena, arena.settings[block.first_setting + i], evaluator, names, entry,
                             fault)) {
            return false;
        }
        made_.push_back(entry);
    }
    for (const MadeSetting &entry : made_) {
        if (entry.name != NO_ID) {
            parameters.set_named(entry.name, evaluator.isGlobal(entry.name), entry.value);
        } else {
            parameters.set(entry.number, entry.value);
        }
    }
    return true;
}

bool BlockSettings::compute_setting(const Arena &arena, const Setting &setting, const Evaluator &evaluator,
                                    const Names &names, MadeSetting &out, Fault &fault) {
    out.name = setting.name;
    if (setting.name != NO_ID && evaluator.isReadOnly(setting.name)) {
        return fault.set(fmt::format("Cannot assign to read-only parameter #<{}>", names.text(setting.name)),
                         setting.column);
    }
    if (setting.name == NO_ID) {
        double index = 0;
        if (!evaluator.value(arena, setting.index, index)) {
            return false;
        }
        if (!Evaluator::take_number(index, out.number)) {
            return Evaluator::refuse_number(index, setting.column, fault);
        }
        if (isBuiltInNumber(out.number)) {
            return fault.set(fmt::format("Parameter is readonly: #{}", out.number), setting.column);
        }
    }
    return evaluator.value(arena, setting.value, out.value);
}

}  // namespace mw::gcode::detail
