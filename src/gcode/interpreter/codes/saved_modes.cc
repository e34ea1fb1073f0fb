// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/codes/saved_modes.hh"

#include <utility>

namespace mw::gcode::detail {

std::optional<State> SavedModes::pop_call() {
    std::optional<State> out;
    const Level &level = levels_.back();
    if (level.modes && level.for_return) {
        out = level.modes;
    }
    levels_.pop_back();
    ++revision_;
    forget_undo();
    return out;
}

void SavedModes::drop_calls(std::size_t depth) {
    while (levels_.size() > depth + 1) {
        levels_.pop_back();
        ++revision_;
    }
    forget_undo();
}

void SavedModes::change(Level &&level) {
    log_.push_back({levels_.size() - 1, std::move(levels_.back())});
    levels_.back() = std::move(level);
    ++revision_;
}

void SavedModes::forget_undo() {
    std::erase_if(log_, [this](const Undo &undo) { return undo.level >= levels_.size(); });
}

void SavedModes::rollback() {
    for (; !log_.empty(); log_.pop_back()) {
        ++revision_;
        levels_[log_.back().level] = std::move(log_.back().before);
    }
}

int SavedModes::status(std::size_t level) const {
    constexpr int SAVED = 1, FOR_RETURN = 2;
    const Level &at = levels_[level];
    return (at.modes ? SAVED : 0) | (at.for_return ? FOR_RETURN : 0);
}

}  // namespace mw::gcode::detail
