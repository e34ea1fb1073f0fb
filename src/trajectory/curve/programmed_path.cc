// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/curve/programmed_path.hh"

#include <algorithm>
#include <cmath>

namespace mw::trajectory::curve {

void ProgrammedPath::add(const Primitive &primitive, double tolerance) {
    moves_.push_back({primitive, length(), tolerance});
}

void ProgrammedPath::drop_before(double s) noexcept {
    std::size_t count = 0;
    while (count + 1 < moves_.size() && moves_[count].end_s() < s) {
        ++count;
    }
    moves_.erase(moves_.begin(), moves_.begin() + static_cast<long>(count));
}

std::size_t ProgrammedPath::move_at(double s, std::size_t near) const noexcept {
    while (near + 1 < moves_.size() && s >= moves_[near].end_s()) {
        ++near;
    }
    while (near > 0 && s < moves_[near].start_s) {
        --near;
    }
    return near;
}

Pose ProgrammedPath::position_at(std::size_t index, double s) const noexcept {
    const ProgrammedMove &m = moves_[index];
    return trajectory::position_at(m.primitive, s - m.start_s);
}

Pose ProgrammedPath::mean(std::size_t index, double from, double to) const noexcept {
    if (!(to > from)) {
        return position_at(index, from);
    }
    // Differences to `base` keep a coordinate that does not move constant to the last digit.
    const Pose base = position_at(index, from);
    Pose sum;
    for (double s = from; s < to;) {
        const bool isLast = index + 1 == moves_.size();
        const double end = isLast ? to : std::min(to, moves_[index].end_s());
        // Simpson's rule is exact for lines, and nearly exact for the short part of an arc within a knot
        // spacing.
        sum = sum + ((position_at(index, s) - base) + (position_at(index, 0.5 * (s + end)) - base) * 4 +
                     (position_at(index, end) - base)) *
                        ((end - s) / 6);
        s = end;
        index += isLast ? 0 : 1;
    }
    return base + sum * (1 / (to - from));
}

}  // namespace mw::trajectory::curve
