// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/codes/saved_modes.hh"

namespace mw::interp::detail {

std::optional<State> SavedModes::pop_call() {
    std::optional<State> out;
    const Level &level = levels_.back();
    if (level.modes && level.isForReturn) {
        out = level.modes;
    }
    levels_.pop_back();
    return out;
}

void SavedModes::drop_calls(std::size_t depth) {
    while (levels_.size() > depth + 1) {
        levels_.pop_back();
    }
}

int SavedModes::status(std::size_t level) const {
    constexpr int SAVED = 1, FOR_RETURN = 2;
    const Level &at = levels_[level];
    return (at.modes ? SAVED : 0) | (at.isForReturn ? FOR_RETURN : 0);
}

}  // namespace mw::interp::detail
