// SPDX-License-Identifier: GPL-2.0-or-later
// Blocks with remapped codes, M98 and M99.
#include <fmt/format.h>

#include "interp/codes/executor.hh"

namespace mw::interp::detail {

/// A code's row: a remap, unless its own subroutine runs, else the table's.
const Code *Executor::lookup(char letter_char, int number) const {
    if (const Code *const remapped = remaps.find(letter_char, number); remapped != nullptr) {
        return remapped;
    }
    const bool isWord = letter_char != 'g' && letter_char != 'm';
    return isWord ? find_word_code(letter_char) : find_code(letter_char, number);
}

/// Keeps the rest of the block for after the procedure.
bool Executor::stop_at_remap(const BlockValues &values, std::size_t index) {
    remaps.interrupt(
        {values.codes[index].code->remap, values, index + 1, comment_, block_place.line, block_number_});
    outcome = Outcome::REMAP;
    return true;
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
        if (block_place.call_level == 0) {
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
