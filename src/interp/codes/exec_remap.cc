// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks with remapped codes, M98 and M99.
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {

Result<> Executor::load_remaps() {
    remaps_.clear();
    refused_remaps_.clear();
    for (const RemapLine &line : settings_.remaps) {
        Result<Remap> made = parse_remap(line);
        if (!made) {
            return std::unexpected(made.error());
        }
        if (!made->refusal.empty()) {
            refused_remaps_.push_back(std::move(made->refusal));
            continue;
        }
        for (const Remap &other : remaps_) {
            if (other.letter == made->letter && other.number == made->number) {
                return fail(fmt::format("REMAP={}: {} is remapped twice", line.text, made->name), line.place);
            }
        }
        remaps_.push_back(std::move(*made));
    }
    for (Remap &remap : remaps_) {
        remap.code.remap = &remap;
    }
    return {};
}

bool Executor::isRunning(const Remap &remap) const {
    return std::ranges::any_of(running_remaps_,
                               [&remap](const RunningRemap &running) { return running.remap == &remap; });
}

/// A code's row: a remap, unless its own subroutine runs, else the table's.
const Code *Executor::lookup(char letter_char, int number) const {
    for (const Remap &remap : remaps_) {
        if (remap.letter == letter_char && remap.number == number && !isRunning(remap)) {
            return &remap.code;
        }
    }
    const bool isWord = letter_char != 'g' && letter_char != 'm';
    return isWord ? find_word_code(letter_char) : find_code(letter_char, number);
}

/// Why a code means nothing here although it is remapped: its own procedure runs.
std::string Executor::recursion_text(char letter_char, int number) const {
    for (const RunningRemap &running : running_remaps_) {
        const Remap &remap = *running.remap;
        if (remap.letter == letter_char && remap.number == number) {
            return fmt::format("{} stands in its own procedure: it has no meaning but the remapped one",
                               remap.name);
        }
    }
    return {};
}

void Executor::count_builtin(const Code &code) {
    for (RunningRemap &running : running_remaps_) {
        if (running.remap->letter == code.letter && running.remap->number == code.number) {
            ++running.builtins;
        }
    }
}

/// Keeps the rest of the block for after the subroutine.
bool Executor::stop_at_remap(const BlockValues &values, std::size_t index) {
    remap_ = static_cast<const Remap *>(values.codes[index].code->remap);
    pending_.emplace(PendingBlock{values, index + 1, comment_, line_, block_number_});
    outcome = Outcome::REMAP;
    return true;
}

bool Executor::check_remap_words(std::string &missing) const {
    const BlockValues &values = pending_->values;
    const auto add = [&missing](std::string_view what) {
        missing += missing.empty() ? "" : ",";
        missing += what;
    };
    for (const RemapWord &word : remap_->words) {
        if (word.isRequired && !values.has(word.letter)) {
            const char upper = static_cast<char>(std::toupper(word.letter));
            add({&upper, 1});
        }
    }
    if (remap_->needsFeed && state.feed <= 0.0) {
        add("F>0");
    }
    if (remap_->needsSpeed && state.spindles[0].speed <= 0.0) {
        add("S>0");
    }
    return missing.empty();
}

PendingBlock Executor::take_pending() {
    PendingBlock out = std::move(*pending_);
    pending_.reset();
    return out;
}

/// Words become local names of the subroutine, or #1, #2, ... in the order of the argspec.
void Executor::set_remap_arguments(const Remap &remap, const PendingBlock &pending) {
    running_remaps_.push_back({&remap, 0});
    for (int i = 1; i <= ARGUMENT_COUNT; ++i) {
        parameters.set(i, 0.0);
    }
    int position = 0;
    for (const RemapWord &word : remap.words) {
        if (!pending.values.has(word.letter)) {
            continue;
        }
        const double value = pending.values.at(word.letter);
        if (remap.isPositional) {
            parameters.set(++position, value);
        } else {
            parameters.set_named(names_.intern(std::string(1, word.letter)), false, value);
        }
    }
    if (remap.wantsLine) {
        parameters.set_named(names_.intern("n"), false, pending.line);
    }
    if (settings_.isArgumentCountNamed && remap.isPositional) {
        parameters.set_named(names_.intern("n_args"), false, position);
    }
    parameters.commit();
}

bool Executor::resume(const PendingBlock &pending) {
    begin_block();
    comment_ = pending.comment;
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
    if (fanuc_count < 0) {
        return fault.set("The number of calls L of M98 must not be negative", values.column_of('l'));
    }
    outcome = Outcome::CALL_FANUC;
    return true;
}

}  // namespace mw::interp::detail
