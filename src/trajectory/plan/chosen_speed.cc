// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/plan/chosen_speed.hh"

#include <algorithm>
#include <array>

namespace mw::trajectory::plan {

ChosenSpeed choose_speed(SpeedChooser &chooser, const ChoiceOfSpeed &choice, const Limits &limits) noexcept {
    const Primitive &p = choice.primitive;
    const SpeedLimit limit = limit_of(p, 0, p.length, limits, UNLIMITED);
    SpeedStretch stretch;
    stretch.length = p.length;
    stretch.cap = std::min(choice.most, limit.v);
    stretch.speed = std::min(choice.before, stretch.cap);
    stretch.out = stretch.cap;
    stretch.at_rest = limit.a.at(0);
    stretch.at_cap = limit.a.at(stretch.cap * stretch.cap);
    stretch.line = choice.tag.line;
    stretch.isEnd = choice.is_end;
    std::array<ChosenPhase, CHOSEN_PHASES> phases;
    const int count = chooser.choose(stretch, phases);
    const bool is_answer = count > 0 && count <= static_cast<int>(phases.size());
    const std::span<const ChosenPhase> chosen(phases.data(), is_answer ? static_cast<std::size_t>(count) : 0);
    ChosenSpeed out;
    out.overreach = check_choice(stretch, limit.a, chosen);
    if (out.overreach.kind != Overreach::Kind::NONE) {
        out.overreach.move = choice.number;
        return out;
    }
    for (const ChosenPhase &phase : chosen) {
        out.most = std::max(out.most, phase.speed);
    }
    return out;
}

}  // namespace mw::trajectory::plan
