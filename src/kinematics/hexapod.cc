// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/hexapod.hh"

#include <algorithm>

namespace mw::kinematics {

Vector Hexapod::row(Group group, std::size_t strut) const noexcept {
    const std::size_t i = index_of(group, strut);
    return {get(i), get(i + 1), get(i + 2)};
}

/// Size of the platform, by which rotations are scaled to lengths.
double Hexapod::size() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < STRUTS; ++i) {
        sum += length(row(PLATFORM, i));
    }
    return std::max(sum / STRUTS, 1e-9);
}

/// The angle between the cross pieces of both joints, about the screw axis of the strut.
double Hexapod::correction_of(std::size_t strut, const Vector &along, const Rotation &turn) const noexcept {
    const double lead = get(SCREW_LEAD);
    if (lead == 0.0) {
        return 0;
    }
    const Vector strut_axis = direction(along);
    const Vector low = cross(row(BASE_AXIS, strut), strut_axis);
    const Vector high = cross(turn * row(PLATFORM_AXIS, strut), strut_axis);
    const double sizes = length(low) * length(high);
    const double sine_of_twist = sizes > 0 ? dot(cross(low, high), strut_axis) / sizes : 0.0;
    return lead / (2.0 * std::numbers::pi) * std::asin(std::clamp(sine_of_twist, -1.0, 1.0));
}

Hexapod::Struts Hexapod::struts_of(const Vector &place, const Rotation &turn) const noexcept {
    Struts out;
    const Vector spindle{0, 0, get(SPINDLE_OFFSET)};
    const Vector tool{0, 0, get(TOOL_OFFSET)};
    for (std::size_t i = 0; i < STRUTS; ++i) {
        out[i].arm = turn * (row(PLATFORM, i) + spindle + tool);
        out[i].along = place - tool + out[i].arm - row(BASE, i) - spindle;
        out[i].correction = correction_of(i, out[i].along, turn);
    }
    return out;
}

/// Derivatives of the strut lengths by the position and rotation of the platform; a rotation is measured as
/// arc length at the rim.
Square<Hexapod::STRUTS> Hexapod::derivatives_of(const Struts &struts, double rim) noexcept {
    Square<STRUTS> m{};
    for (std::size_t i = 0; i < STRUTS; ++i) {
        const Vector u = direction(struts[i].along);
        const Vector turn = cross(struts[i].arm, u) * (1.0 / rim);
        m[i] = {u.x, u.y, u.z, turn.x, turn.y, turn.z};
    }
    return m;
}

Status Hexapod::inverse(const Pose &pose, double *joints) const noexcept {
    const Struts struts = struts_of(place_of(pose), rotation_of(pose));
    Row<STRUTS> lengths{};
    for (std::size_t i = 0; i < STRUTS; ++i) {
        lengths[i] = length(struts[i].along) + struts[i].correction;
    }
    if (!isFinite(pose) || !areFinite(lengths.data(), STRUTS)) {
        return Status::UNREACHABLE;
    }
    Row<STRUTS> right{};
    const double pivot = solve(derivatives_of(struts, size()), right);
    std::copy(lengths.begin(), lengths.end(), joints);
    return pivot > SINGULAR_PIVOT ? Status::OK : Status::SINGULAR;
}

int Hexapod::side(const Pose &pose) const noexcept {
    Row<STRUTS> right{};
    int turn = 0;
    solve(derivatives_of(struts_of(place_of(pose), rotation_of(pose)), size()), right, turn);
    return turn;
}

Status Hexapod::forward(const double *joints, Pose &pose) const noexcept {
    int iterations = 0;
    return forward(joints, pose, iterations);
}

Status Hexapod::forward(const double *joints, Pose &pose, int &iterations) const noexcept {
    struct Search {
        const Hexapod &hexapod;
        double rim;
        Vector place;
        Rotation turn;
        Vector move, spin;  ///< [machine units] of the path; [rad] about an axis

        Vector place_ahead(double share) const noexcept { return place + move * share; }
        Rotation turn_ahead(double share) const noexcept { return rotation_about(spin * share) * turn; }
        StrutLengths<STRUTS> lengths_at(double share) const noexcept {
            const Struts struts = hexapod.struts_of(place_ahead(share), turn_ahead(share));
            StrutLengths<STRUTS> out;
            std::transform(struts.begin(), struts.end(), out.of.begin(),
                           [](const Strut &strut) { return length(strut.along) + strut.correction; });
            out.by = derivatives_of(struts, rim);
            return out;
        }
        double go(double share, const Row<STRUTS> &step) noexcept {
            place = place_ahead(share);
            turn = turn_ahead(share);
            move = {step[0], step[1], step[2]};
            spin = Vector{step[3], step[4], step[5]} * (1.0 / rim);
            return std::max(length(move), length(spin) * rim);
        }
    };
    iterations = 0;
    if (!areFinite(joints, STRUTS) || !isFinite(pose)) {
        return Status::UNREACHABLE;
    }
    const double rim = size();
    Search search{*this, rim, place_of(pose), rotation_of(pose), {}, {}};
    const NewtonTerms terms{get(CRITERION), get(MAX_ERROR), get(LIMIT_ITERATIONS), rim};
    double share = 1;
    const Status status = find_platform<STRUTS>(joints, terms, search, share, iterations);
    if (isAnswered(status)) {
        set_place(pose, search.place_ahead(share));
        set_rotation(pose, search.turn_ahead(share));
    }
    return status;
}

Row<Hexapod::STRUTS> Hexapod::corrections_at(const Pose &pose) const noexcept {
    const Struts struts = struts_of(place_of(pose), rotation_of(pose));
    Row<STRUTS> out{};
    std::transform(struts.begin(), struts.end(), out.begin(),
                   [](const Strut &strut) { return strut.correction; });
    return out;
}

}  // namespace mw::kinematics
