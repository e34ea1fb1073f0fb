// SPDX-License-Identifier: GPL-2.0-or-later
#include "kins/pentapod.hh"

#include <algorithm>

namespace mw::kins {

/// Of the effector, which turns are measured by.
double Pentapod::size() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < STRUTS; ++i) {
        sum += std::abs(get(5 * i + 3)) + std::abs(get(5 * i + 4));
    }
    return std::max(sum / STRUTS, 1e-9);
}

Pentapod::Lengths Pentapod::lengths_at(const Pose &pose) const noexcept {
    const double ca = cosine(pose[geom::AXIS_A]);
    const double sa = sine(pose[geom::AXIS_A]);
    const double cb = cosine(pose[geom::AXIS_B]);
    const double sb = sine(pose[geom::AXIS_B]);
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
    constexpr double MOST_ITERATIONS = 1000;
    constexpr double STRIDE =
        0.05;  // of the rim; a longer one may lead to another way to put the struts together
    iterations = 0;
    if (!areFinite(joints, STRUTS) || !isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const double rim = size();
    const int limit = static_cast<int>(std::min(get(LIMIT_ITERATIONS), MOST_ITERATIONS));
    Pose at = pose;
    Pose way;          // from there to where the solution is looked for next
    double share = 1;  // of it
    double before = 1e300;
    int side_at_start = 0;
    for (; iterations < limit; ++iterations) {
        const Pose here = at + way * share;
        const Lengths lengths = lengths_at(here);
        Row<STRUTS> step{};
        double miss = 0;
        for (std::size_t i = 0; i < STRUTS; ++i) {
            step[i] = joints[i] - lengths.of[i];
            miss = std::max(miss, std::abs(step[i]));
        }
        int side_here = 0;
        const double pivot = solve(lengths.by, step, side_here);
        side_at_start = iterations == 0 ? side_here : side_at_start;
        const bool isSameSide = side_here == side_at_start || pivot <= SINGULAR_PIVOT;
        // One step beyond what is asked for takes the rest of the error, where rounding leaves anything to
        // take.
        const bool isSettled =
            miss < get(CRITERION) && (miss < 1e-6 * get(CRITERION) || miss >= 0.5 * before);
        if (isSettled && isSameSide) {
            pose = here;
            return pivot > SINGULAR_PIVOT ? Status::OK : Status::SINGULAR;
        }
        if (!(miss <= get(MAX_ERROR)) || !(pivot > 0)) {
            return Status::UNREACHABLE;
        }
        if (!isSameSide || miss > before) {
            share *= 0.5;  // too far
            continue;
        }
        at = here;
        way = {{step[0], step[1], step[2], step[3] / rim * DEGREES, step[4] / rim * DEGREES}};
        const double most = std::max({length(place_of(way)), std::abs(step[3]), std::abs(step[4]), 1e-300});
        share = std::min(1.0, STRIDE * rim / most);
        before = miss;
    }
    return Status::UNREACHABLE;
}

}  // namespace mw::kins
