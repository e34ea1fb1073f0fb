// SPDX-License-Identifier: GPL-2.0-or-later
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

double FeedLimit::share(const Pose &first) const noexcept {
    const double length = along == Along::XYZ   ? geometry::norm_xyz(first)
                          : along == Along::UVW ? geometry::norm_uvw(first)
                                                : 1.0;
    return length * length / (velocity * velocity);
}

std::size_t Run::feed_at(double s) const noexcept {
    const auto at = std::lower_bound(feeds->begin(), feeds->end(), s,
                                     [](const FeedLimit &f, double x) { return f.end_s < x; });
    return std::min(static_cast<std::size_t>(at - feeds->begin()), feeds->size() - 1);
}

void Run::find_cap_reach() noexcept {
    cap_reach = 0;
    for (std::size_t k = 0; caps != nullptr && k < caps->size(); ++k) {
        cap_reach = std::max(cap_reach, (*caps)[k].reach);
    }
}

void Run::add_joints(curve::JointCurve &curve, const JointLimits &accuracy, double from_s) {
    if (map == nullptr || joints.count == 0) {
        return;
    }
    if (curve.joints() == 0) {
        curve.begin(map, accuracy);
    }
    curve.cover(*spans);
    curve.drop_before(from_s);
    joint_curve = &curve;
    if (curve.drivable_s() < end_s) {
        end_s = curve.drivable_s();
        has_stop = true;
    }
}

std::size_t span_at(const std::vector<Span> &spans, double s) noexcept {
    const auto behind = std::upper_bound(spans.begin(), spans.end(), s,
                                         [](double x, const Span &span) { return x < span.start_s; });
    return static_cast<std::size_t>(std::max<long>(0, behind - spans.begin() - 1));
}

}  // namespace mw::trajectory::profile
