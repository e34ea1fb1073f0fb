// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/pentapod.hh"

#include <algorithm>

namespace mw::kinematics {

/// Size of the effector, by which rotations are scaled to lengths.
double Pentapod::size() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < STRUTS; ++i) {
        sum += std::abs(get(5 * i + 3)) + std::abs(get(5 * i + 4));
    }
    return std::max(sum / STRUTS, 1e-9);
}

Pentapod::Lengths Pentapod::lengths_at(const Pose &pose) const noexcept {
    const double ca = cosine(pose[geometry::AXIS_A]);
    const double sa = sine(pose[geometry::AXIS_A]);
    const double cb = cosine(pose[geometry::AXIS_B]);
    const double sb = sine(pose[geometry::AXIS_B]);
    const Vector axis{ca * sb, -sa, ca * cb};
    const Vector axis_by[] = {{-sa * sb, -ca, -sa * cb}, {ca * cb, 0, -ca * sb}};  // A, B
    const double tool = get(TOOL_OFFSET);
    const Vector origin = place_of(pose) + axis * tool - Vector{0, 0, tool};
    const double rim = size();
    Lengths out;
    for (std::size_t i = 0; i < STRUTS; ++i) {
        const Vector off = Vector{get(5 * i), get(5 * i + 1), get(5 * i + 2)} - origin;
        const double height = dot(off, axis);
        const Vector outward = off - axis * height;
        const double distance = length(outward);
        const double rise = height - get(5 * i + 4);
        const double reach = distance - get(5 * i + 3);
        const double strut = std::hypot(rise, reach);
        out.of[i] = strut;
        const auto follow = [&](const Vector &off_by, const Vector &turn_by) {
            const double height_by = dot(off_by, axis) + dot(off, turn_by);
            const double distance_by = (dot(off, off_by) - height * height_by) / distance;
            return (rise * height_by + reach * distance_by) / strut;
        };
        out.by[i] = {follow({-1, 0, 0}, {}), follow({0, -1, 0}, {}), follow({0, 0, -1}, {}),
                     follow(axis_by[0] * -tool, axis_by[0]) / rim,
                     follow(axis_by[1] * -tool, axis_by[1]) / rim};
    }
    return out;
}

Status Pentapod::inverse(const Pose &pose, double *joints) const noexcept {
    const Lengths lengths = lengths_at(pose);
    if (!isFinite(pose) || !areFinite(lengths.of.data(), STRUTS)) {
        return Status::UNREACHABLE;
    }
    Row<STRUTS> right{};
    const double pivot = solve(lengths.by, right);
    std::copy(lengths.of.begin(), lengths.of.end(), joints);
    return pivot > SINGULAR_PIVOT ? Status::OK : Status::SINGULAR;
}

int Pentapod::side(const Pose &pose) const noexcept {
    Row<STRUTS> right{};
    int turn = 0;
    solve(lengths_at(pose).by, right, turn);
    return turn;
}

Status Pentapod::forward(const double *joints, Pose &pose) const noexcept {
    int iterations = 0;
    return forward(joints, pose, iterations);
}

Status Pentapod::forward(const double *joints, Pose &pose, int &iterations) const noexcept {
    struct Search {
        const Pentapod &pentapod;
        double rim;
        Pose at, way;

        Pose ahead(double share) const noexcept { return at + way * share; }
        Lengths lengths_at(double share) const noexcept { return pentapod.lengths_at(ahead(share)); }
        double go(double share, const Row<STRUTS> &step) noexcept {
            at = ahead(share);
            way = {{step[0], step[1], step[2], step[3] / rim * DEGREES, step[4] / rim * DEGREES}};
            return std::max({length(place_of(way)), std::abs(step[3]), std::abs(step[4])});
        }
    };
    iterations = 0;
    if (!areFinite(joints, STRUTS) || !isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const double rim = size();
    Search search{*this, rim, pose, {}};
    const NewtonTerms terms{get(CRITERION), get(MAX_ERROR), get(LIMIT_ITERATIONS), rim};
    double share = 1;
    const Status status = find_platform<STRUTS>(joints, terms, search, share, iterations);
    if (isAnswered(status)) {
        pose = search.ahead(share);
    }
    return status;
}

}  // namespace mw::kinematics
