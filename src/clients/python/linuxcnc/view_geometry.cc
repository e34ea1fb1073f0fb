// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/linuxcnc/view_geometry.hh"

#include <cmath>
#include <numbers>

namespace mw::python {
namespace {

/// Rotates `p` in the plane of two of its coordinates, from the first to the second.
void turn(double degrees, const Vertex &centre, std::size_t first, std::size_t second, Vertex &p) {
    const double angle = degrees * std::numbers::pi / 180;
    const double c = std::cos(angle), s = std::sin(angle);
    const double x = p[first] - centre[first], y = p[second] - centre[second];
    p[first] = centre[first] + x * c - y * s;
    p[second] = centre[second] + x * s + y * c;
}

}  // namespace

Vertex vertex_of(const std::string &geometry, const geometry::Pose &pose, const RotationCentre &rotation) {
    Vertex p{};
    double sign = 1;
    for (const char letter : geometry) {
        if (letter == '-') {
            sign = -1;
            continue;
        }
        const int axis = geometry::axis_of_letter(letter);
        if (axis >= 0 &&
            (!geometry::isAngular(axis) || rotation.turning.test(static_cast<std::size_t>(axis)))) {
            const double value = sign * pose[axis];
            switch (axis) {
            // B rotates from X to Z, because configurations select their signs by this convention.
            case geometry::AXIS_A: turn(value, rotation.centre, 1, 2, p); break;
            case geometry::AXIS_B: turn(value, rotation.centre, 0, 2, p); break;
            case geometry::AXIS_C: turn(value, rotation.centre, 0, 1, p); break;
            default: p[static_cast<std::size_t>(axis % 3)] += value; break;
            }
        }
        sign = 1;
    }
    return p;
}

void ViewGeometry::choose(const std::string &coordinates, bool offset) {
    const std::lock_guard lock(mutex_);
    offset_ = offset;
    turning_.reset();
    for (const char letter : coordinates) {
        if (const int axis = geometry::axis_of_letter(letter); axis >= 0) {
            turning_.set(static_cast<std::size_t>(axis));
        }
    }
}

void ViewGeometry::place_origin(const Vertex &origin) {
    const std::lock_guard lock(mutex_);
    origin_ = origin;
}

RotationCentre ViewGeometry::centre() const {
    const std::lock_guard lock(mutex_);
    return {offset_ ? origin_ : Vertex{}, turning_};
}

}  // namespace mw::python
