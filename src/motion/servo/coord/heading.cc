// SPDX-License-Identifier: GPL-2.0-or-later
#include "motion/servo/coord/heading.hh"

#include <cmath>
#include <numbers>

namespace mw::motion {
namespace {

constexpr double FULL_TURN_DEG = 360.0, QUARTER_TURN_DEG = 90.0, HALF_TURN_DEG = 180.0;
constexpr double DEG_PER_RAD = HALF_TURN_DEG / std::numbers::pi;
/// A shorter move has no direction [machine units].
constexpr double LEAST_LENGTH = 1e-9;
constexpr int G0 = 0, G1 = 10, G2 = 20, G3 = 30, G38 = 380;

using Vector = std::array<double, 3>;

/// An angle within a revolution, in [0, 360).
double turned(double degrees) noexcept {
    const double low = degrees < 0 ? degrees + FULL_TURN_DEG : degrees;
    return low >= FULL_TURN_DEG ? low - FULL_TURN_DEG : low;
}

/// False if there is no direction in XY.
bool point(double x, double y, double &degrees) noexcept {
    if (x * x + y * y < LEAST_LENGTH * LEAST_LENGTH) {
        return false;
    }
    degrees = turned(std::atan2(y, x) * DEG_PER_RAD);
    return true;
}

Vector cross(const Vector &a, const Vector &b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The axis about which the arc is counter-clockwise.
Vector axis_of(const trajectory::Primitive &arc) noexcept {
    Vector axis = cross(arc.u, arc.v);
    if (arc.omega < 0) {
        axis = {-axis[0], -axis[1], -axis[2]};
    }
    return axis;
}

/// True if counter-clockwise seen from the positive end of the machine axis nearest to `axis`.
bool isCounterClockwise(const Vector &axis) noexcept {
    std::size_t largest = 0;
    for (std::size_t i = 1; i < axis.size(); ++i) {
        largest = std::fabs(axis[i]) > std::fabs(axis[largest]) ? i : largest;
    }
    return axis[largest] > 0;
}

int g_code_of(MotionType type, bool isArc, bool isLeft) noexcept {
    switch (type) {
    case MotionType::FEED: return G1;
    case MotionType::ARC: return isArc && !isLeft ? G2 : G3;
    case MotionType::PROBING: return G38;
    case MotionType::NONE:
    case MotionType::TRAVERSE:
    case MotionType::TOOL_CHANGE:
    case MotionType::INDEX_ROTARY: break;
    }
    return G0;
}

/// An arc about Z: the centre is perpendicular to the direction.
void follow_flat_arc(const trajectory::Primitive &arc, bool isLeft, const geometry::Pose &place,
                     Heading &out) noexcept {
    const double x = arc.base[0] - place[0], y = arc.base[1] - place[1];
    out.isArc = true;
    out.radius = std::sqrt(x * x + y * y);
    out.centre = {arc.base[0], arc.base[1], place[2]};
    if (point(x, y, out.to_centre_deg)) {
        out.direction_deg = turned(out.to_centre_deg + (isLeft ? -QUARTER_TURN_DEG : QUARTER_TURN_DEG));
    }
}

void follow_arc(const trajectory::Primitive &arc, const Vector &axis, const geometry::Pose &place,
                Heading &out) noexcept {
    Vector out_of_centre{};
    double along = 0;
    for (int i = 0; i < 3; ++i) {
        const auto n = static_cast<std::size_t>(i);
        out_of_centre[n] = place[i] - arc.base[i];
        along += out_of_centre[n] * axis[n];
    }
    for (int i = 0; i < 3; ++i) {
        const auto n = static_cast<std::size_t>(i);
        out_of_centre[n] -= along * axis[n];
        out.centre[n] = arc.base[i] + along * axis[n];  // the centre of a helix moves along its axis
    }
    out.isArc = true;
    out.radius = std::hypot(out_of_centre[0], out_of_centre[1], out_of_centre[2]);
    const Vector tangent = cross(axis, out_of_centre);
    point(tangent[0], tangent[1], out.direction_deg);
    point(-out_of_centre[0], -out_of_centre[1], out.to_centre_deg);
}

}  // namespace

Heading heading_of(const trajectory::Primitive &move, MotionType type, const geometry::Pose &place,
                   bool isReverse, const Heading &before) noexcept {
    Heading out;
    out.direction_deg = before.direction_deg;
    out.to_centre_deg = before.to_centre_deg;
    const bool isArc = move.isArc && move.space == geometry::AXIS_X;
    const Vector axis = isArc ? axis_of(move) : Vector{};
    const bool isFlat = axis[0] == 0 && axis[1] == 0;
    const bool isLeft = isFlat ? axis[2] > 0 : isCounterClockwise(axis);
    out.g_code = g_code_of(type, isArc, isLeft);
    if (isArc && isFlat) {
        follow_flat_arc(move, isLeft, place, out);
    } else if (isArc) {
        follow_arc(move, axis, place, out);
    } else if (point(move.end[0] - move.start[0], move.end[1] - move.start[1], out.direction_deg)) {
        out.to_centre_deg = turned(out.direction_deg + QUARTER_TURN_DEG);
    }
    if (isReverse) {
        out.direction_deg = turned(out.direction_deg + HALF_TURN_DEG);
    }
    return out;
}

}  // namespace mw::motion
