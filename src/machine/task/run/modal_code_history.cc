// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/modal_code_history.hh"

#include <algorithm>
#include <iterator>

namespace mw::task {
namespace {

bool areSameModes(const gcode::ActiveCodes &a, const gcode::ActiveCodes &b) {
    constexpr int BEHIND_NUMBER = 1;
    return std::equal(a.g.begin() + BEHIND_NUMBER, a.g.end(), b.g.begin() + BEHIND_NUMBER) &&
           std::equal(a.m.begin() + BEHIND_NUMBER, a.m.end(), b.m.begin() + BEHIND_NUMBER) &&
           std::equal(a.settings.begin() + BEHIND_NUMBER, a.settings.end(),
                      b.settings.begin() + BEHIND_NUMBER);
}

}  // namespace

void ModalCodeHistory::note(std::uint32_t block, const gcode::ActiveCodes &codes) {
    const bool known = !entries_.empty() && block <= newest_;
    if (known || (!entries_.empty() && areSameModes(entries_.back().codes, codes))) {
        newest_ = std::max(newest_, block);
        return;
    }
    newest_ = block;
    entries_.push_back({block, codes});
    if (entries_.size() > MAX_ENTRIES) {
        entries_.pop_front();
    }
}

gcode::ActiveCodes ModalCodeHistory::at(std::uint32_t block, int line) const {
    const auto behind = std::ranges::upper_bound(entries_, block, {}, &Entry::block);
    return numbered(behind == entries_.begin() ? behind->codes : std::prev(behind)->codes, line);
}

gcode::ActiveCodes numbered(gcode::ActiveCodes codes, int line) {
    codes.g[0] = codes.m[0] = line;
    codes.settings[0] = line;
    return codes;
}

}  // namespace mw::task
