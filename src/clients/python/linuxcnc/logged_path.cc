// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/logged_path.hh"

#include <cmath>

namespace mw::python {
namespace {

/// Maximum difference from 1 of the cosine of the angle on a straight line.
constexpr double STRAIGHT = 1e-4;

std::array<double, 3> step_of(const LoggedPoint &from, const LoggedPoint &to) {
    return {to.x - from.x, to.y - from.y, to.z - from.z};
}

double dot(const std::array<double, 3> &a, const std::array<double, 3> &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

/// Compares the step to the sample with the direction of the last step. Compared with the line from its
/// start, an arc would never end the line, because each sample changes the direction only slightly.
bool LoggedPath::isStraightOn(const LoggedPoint &sample) const {
    const LoggedPoint &last = points_.back(), &before = points_[points_.size() - 2];
    const auto way = step_of(before, last), next = step_of(last, sample);
    const double lengths = std::sqrt(dot(way, way) * dot(next, next));
    const bool other_end_still = last.a == sample.a && last.b == sample.b && last.c == sample.c;
    return other_end_still && (lengths == 0 || dot(way, next) / lengths > 1 - STRAIGHT);
}

void LoggedPath::add(const LoggedPoint &sample) {
    if (points_.empty()) {
        points_.push_back(sample);
        return;
    }
    if (points_.back().colour != sample.colour) {
        LoggedPoint corner = points_.back();  // the new colour begins at the end of the old one
        corner.colour = sample.colour;
        corner.other_colour = sample.other_colour;
        points_.push_back(corner);
        points_.push_back(sample);
    } else if (points_.size() > 1 && isStraightOn(sample)) {
        points_.back() = sample;
    } else {
        points_.push_back(sample);
    }
    if (points_.size() > MAX_POINTS) {
        points_.erase(points_.begin(), points_.begin() + MAX_POINTS / 10);
    }
}

}  // namespace mw::python
