// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/certificate/limit_use.hh"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mw::machine {

bool CoordinateUse::hasLimit(std::size_t derivative) const {
    return std::isfinite(coordinate.limit[derivative]);
}

double CoordinateUse::ratio(std::size_t derivative) const {
    return hasLimit(derivative) ? largest[derivative].value / coordinate.limit[derivative] : 0;
}

LimitUse::LimitUse(std::vector<LimitedCoordinate> coordinates, double period_s) {
    for (const LimitedCoordinate &coordinate : coordinates) {
        uses_.push_back({coordinate, {}});
    }
    per_period_[0] = 1;
    for (std::size_t order = 1; order <= DERIVATIVES; ++order) {
        per_period_[order] = per_period_[order - 1] / period_s;
    }
}

void LimitUse::remember(const Sample &sample) {
    Row difference;
    std::copy(sample.axes.c.begin(), sample.axes.c.end(), difference.begin());
    std::copy(sample.joints.begin(), sample.joints.end(), difference.begin() + MAX_AXES);
    for (std::size_t order = 0; order <= DERIVATIVES; ++order) {
        Row &row = difference_[order];
        Row next;
        for (std::size_t i = 0; i < CHANNELS; ++i) {
            next[i] = difference[i] - row[i];
            row[i] = difference[i];
        }
        difference = next;
    }
    known_ = std::min(known_ + 1, DERIVATIVES + 1);
}

/// The absolute difference, minus 2^order roundings of the position.
double LimitUse::value(const LimitedCoordinate &coordinate, std::size_t order) const {
    constexpr double EPSILON = std::numeric_limits<double>::epsilon();
    const double roundings = EPSILON * static_cast<double>(1U << order);
    const Row &position = difference_[0], &row = difference_[order];
    if (coordinate.type == LimitedCoordinate::Type::XYZ_NORM) {
        const double size = std::max({std::abs(position[0]), std::abs(position[1]), std::abs(position[2])});
        return std::hypot(row[0], row[1], row[2]) - roundings * size;
    }
    const auto i = static_cast<std::size_t>(
        coordinate.index + (coordinate.type == LimitedCoordinate::Type::JOINT ? MAX_AXES : 0));
    return std::abs(row[i]) - roundings * std::abs(position[i]);
}

void LimitUse::measure(const Sample &sample) {
    for (CoordinateUse &use : uses_) {
        for (std::size_t order = 1; order < known_; ++order) {
            const double now = value(use.coordinate, order) * per_period_[order];
            LargestUse &largest = use.largest[order - 1];
            if (now > largest.value) {
                largest = {now, sample.time_ns, sample.source};
            }
        }
    }
}

}  // namespace mw::machine
