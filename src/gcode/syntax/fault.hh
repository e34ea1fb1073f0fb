// SPDX-License-Identifier: GPL-2.0-or-later
// Why a block failed. Rules and handlers return false after setting it.
#pragma once

#include <cstdint>
#include <string>

namespace mw::gcode::detail {

struct Fault {
    std::string message;
    int line = 0;              ///< line of the fault, 0: in the failed block
    std::uint32_t column = 0;  ///< from 1, 0: the whole block
    std::string hint;
    std::string block_text;      ///< shown instead of the line, for calls without a line
    bool program_ended = false;  ///< the missing line would be after the program's end

    /// Clears the fault. Cheaper than assigning a new one before each block.
    void clear() {
        message.clear();
        line = 0;
        column = 0;
        hint.clear();
        block_text.clear();
        program_ended = false;
    }
    /// For `return fault.set(...)`: always false. The line is not changed.
    bool set(std::string text, std::uint32_t where = 0, std::string advice = {}) {
        message = std::move(text);
        column = where;
        hint = std::move(advice);
        return false;
    }
};

}  // namespace mw::gcode::detail
