// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks with remapped codes, M98 and M99.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "interp/detail/executor.hh"

namespace mw::interp::detail {

Result<> Executor::load_remaps() {
    remaps_.clear();
    for (const std::string &line : settings_.remaps) {
        Result<Remap> made = parse_remap(line);
        if (!made) {
            return std::unexpected(made.error());
        }
        remaps_.push_back(std::move(*made));
    }
    for (Remap &remap : remaps_) {
        remap.code.remap = &remap;
    }
    return {};
}

/// A code's row: a remap, unless its own subroutine runs, else the table's.
const Code *Executor::lookup(char letter_char, int number) const {
    for (const Remap &remap : remaps_) {
        const bool isThis = remap.letter == letter_char && remap.number == number;
        if (isThis &&
            std::find(running_remaps_.begin(), running_remaps_.end(), &remap) == running_remaps_.end()) {
            return &remap.code;
        }
    }
    const bool isWord = letter_char != 'g' && letter_char != 'm';
    return isWord ? find_word_code(letter_char) : find_code(letter_char, number);
}

/// Keeps the rest of the block for after the subroutine.
bool Executor::stop_at_remap(const BlockValues &values, std::size_t index) {
    remap_ = static_cast<const Remap *>(values.codes[index].code->remap);
    if (remap_->code.group == Group::MOTION) {
        state.motion = remap_->number;
    }
    pending_.emplace(PendingBlock{values, index + 1});
    outcome = Outcome::REMAP;
    return true;
}

bool Executor::check_remap_words(std::string &missing) const {
    const BlockValues &values = pending_->values;
    for (const char c : remap_->required) {
        if (!values.has(c)) {
            missing += missing.empty() ? "" : ",";
            missing += static_cast<char>(std::toupper(c));
        }
    }
    if (remap_->needsFeed && state.feed <= 0.0) {
        missing += missing.empty() ? "F>0" : ",F>0";
    }
    if (remap_->needsSpeed && state.spindles[0].speed <= 0.0) {
        missing += missing.empty() ? "S>0" : ",S>0";
    }
    return missing.empty();
}

PendingBlock Executor::take_pending() {
    PendingBlock out = *pending_;
    pending_.reset();
    return out;
}

/// Words become local names of the subroutine, or #1, #2, ... in the order of the argspec.
void Executor::set_remap_arguments(const Remap &remap, const BlockValues &values) {
    running_remaps_.push_back(&remap);
    for (int i = 1; i <= ARGUMENT_COUNT; ++i) {
        parameters.set(i, 0.0);
    }
    int position = 0;
    for (const std::vector<char> *list : {&remap.required, &remap.optional_words}) {
        for (const char c : *list) {
            if (!values.has(c)) {
                continue;
            }
            if (remap.isPositional) {
                parameters.set(++position, values.at(c));
            } else {
                parameters.set_named(names_.intern(std::string(1, c)), false, values.at(c));
            }
        }
    }
    if (settings_.isArgumentCountNamed) {
        parameters.set_named(names_.intern("n_args"), false, position);
    }
    parameters.commit();
}

bool Executor::resume(const PendingBlock &pending) {
    begin_block();
    return run_codes(pending.values, pending.next);
}

bool Executor::do_fanuc(const Code &code, const BlockValues &values) {
    if (settings_.isFanucSubDisabled) {
        return fault.set(fmt::format("DISABLE_FANUC_STYLE_SUB set in INI file, but found m{}", code.number));
    }
    if (code.number == 99) {
        if (call_level_ == 0) {
            if (!settings_.isTask) {
                return do_end(*find_code('m', 2), values);
            }
            outcome = Outcome::RESTART;
            return true;
        }
        outcome = Outcome::RETURN_FANUC;
        return true;
    }
    if (!values.has('p')) {
        return fault.set("Found 'm98' code with no P-word");
    }
    fanuc_count = 1;
    if (!whole_word(values, 'p', fanuc_label) || (values.has('l') && !whole_word(values, 'l', fanuc_count))) {
        return false;
    }
    outcome = Outcome::CALL_FANUC;
    return true;
}

}  // namespace mw::interp::detail
