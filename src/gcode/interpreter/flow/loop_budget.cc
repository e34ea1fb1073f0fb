// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/flow/loop_budget.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::gcode::detail {

void LoopBudget::restart() {
    begin_stretch(0);
    spent_ = false;
}

void LoopBudget::begin_stretch(int main_line) {
    furthest_line_ = main_line;
    taken_ = taken_idle_ = 0;
    taken_seconds_ = 0;
    if (!passes_.empty()) {
        passes_.clear();
    }
    if (!watched_.empty()) {
        watched_.clear();
    }
}

bool LoopBudget::isRepeating(const LoopPass &pass, const State &state, const Parameters &parameters) {
    constexpr std::uint64_t LESS_OFTEN = 4;
    if (latest_ >= watched_.size() || !(watched_[latest_].pass == pass)) {
        const auto found = std::ranges::find(watched_, pass, &Watched::pass);
        latest_ = static_cast<std::size_t>(found - watched_.begin());
        if (found == watched_.end()) {
            watched_.emplace_back().pass = pass;
        }
    }
    Watched &loop = watched_[latest_];
    if (loop.last != nullptr) {
        if (loop.last->state == state && parameters.hasValues(loop.last->values)) {
            return true;
        }
        loop.last.reset();
    }
    if (++loop.count == loop.next) {
        loop.next *= LESS_OFTEN;
        loop.last = std::make_unique<LoopSnapshot>(LoopSnapshot{state, parameters.values()});
    }
    return false;
}

std::optional<LoopPass> LoopBudget::loop_around(const Program *program, std::size_t depth, int line) const {
    std::optional<LoopPass> found;
    for (const auto &[pass, count] : passes_) {
        const bool around =
            pass.program == program && pass.depth == depth && pass.first <= line && line <= pass.last;
        const bool longer = !found || pass.last - pass.first > found->last - found->first;
        if (around && longer) {
            found = pass;
        }
    }
    return found;
}

std::string LoopBudget::spend() {
    constexpr double S_PER_HOUR = 3600.0;
    spent_ = true;
    if (idle_ > 0 && taken_idle_ > idle_) {
        return fmt::format("{} statements without a machine action", idle_);
    }
    if (seconds_ > 0 && taken_seconds_ > seconds_) {
        return fmt::format("{:g} hours of machine time", seconds_ / S_PER_HOUR);
    }
    return fmt::format("{} statements", statements_);
}

}  // namespace mw::gcode::detail
