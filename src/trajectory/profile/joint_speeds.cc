// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/joint_speeds.hh"

#include <algorithm>

namespace mw::trajectory::profile {

const std::vector<double> &JointSpeeds::find(const curve::JointCurve &joints, const RestMap &map,
                                             const std::vector<double> &knots, const Known &known) {
    take_parts(joints, map, knots);
    speed_[known.cell] = std::min(speed_[known.cell], known.speed);
    spread(knots);
    return speed_;
}

void JointSpeeds::take_parts(const curve::JointCurve &joints, const RestMap &map,
                             const std::vector<double> &knots) {
    const auto &parts = joints.parts();
    speed_.assign(knots.size() - 1, 1e300);
    length_.assign(knots.size() - 1, 1e300);
    std::size_t part = joints.part_at(map.at(knots[0]).s);
    for (std::size_t k = 0; k < speed_.size(); ++k) {
        const double to = map.at(knots[k + 1]).s;
        for (;; ++part) {
            speed_[k] = std::min(speed_[k], parts[part].speed);
            length_[k] = std::min(length_[k], parts[part].length);
            if (parts[part].end_s() > to || part + 1 == parts.size()) {
                break;
            }
        }
    }
    // The speed at most doubles over the length of a part.
    constexpr double FAR = 1e3;
    for (double factor = 1; factor < FAR && part < parts.size(); factor *= 2) {
        speed_.back() = std::min(speed_.back(), factor * parts[part++].speed);
    }
}

void JointSpeeds::spread(const std::vector<double> &knots) {
    const auto limit = [&](std::size_t k, std::size_t by) {
        const double apart = 0.5 * (knots[k + 1] - knots[k] + knots[by + 1] - knots[by]);
        speed_[k] = std::min(speed_[k], speed_[by] * (1 + apart / std::min(length_[k], length_[by])));
    };
    for (std::size_t k = 1; k < speed_.size(); ++k) {
        limit(k, k - 1);
    }
    for (std::size_t k = speed_.size() - 1; k > 0; --k) {
        limit(k - 1, k);
    }
}

}  // namespace mw::trajectory::profile
