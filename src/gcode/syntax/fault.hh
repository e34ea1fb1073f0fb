// SPDX-License-Identifier: GPL-2.0-or-later
// Why a block failed. Rules and handlers return false after setting it.
#pragma once

#include <cstdint>
#include <string>

namespace mw::gcode::detail {

struct Fault {
    std::string message;
    int line = 0;              ///< where it stands, 0: in the block that has failed
    std::uint32_t column = 0;  ///< from 1, 0: the whole block
    std::string hint;
    std::string block_text;      ///< shown instead of the line, for calls that stand in no line
    bool isProgramOver = false;  ///< what was searched in vain would stand behind the program's end

    /// Nothing has failed. Cheaper than assigning a new one, before each block.
    void clear() {
        message.clear();
        line = 0;
        column = 0;
        hint.clear();
        block_text.clear();
        isProgramOver = false;
    }
    /// For `return fault.set(...)`: always false. The line stays what it is.
    bool set(std::string text, std::uint32_t where = 0, std::string advice = {}) {
        message = std::move(text);
        column = where;
        hint = std::move(advice);
        return false;
    }
};

}  // namespace mw::gcode::detail
