// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/tools/tool_table.hh"

#include <utility>

namespace mw::gcode::detail {

ToolEntry ToolTable::entry(int index) const {
    for (const auto *entries : {&of_block_, &changes_}) {
        if (const auto found = entries->find(index); found != entries->end()) {
            return found->second;
        }
    }
    return source_.entry(index);
}

void ToolTable::commit() {
    if (of_block_.empty()) {
        return;
    }
    for (auto &[index, entry] : of_block_) {
        changes_[index] = std::move(entry);
    }
    of_block_.clear();
}

}  // namespace mw::gcode::detail
