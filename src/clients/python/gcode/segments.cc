// SPDX-License-Identifier: GPL-2.0-or-later
// Arcs as chords, and the extents of moves.
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "base/geometry/pose.hh"
#include "clients/python/gcode/linecode.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

using geometry::Pose;

constexpr double FULL_TURN = 2 * std::numbers::pi;
constexpr int DEFAULT_SEGMENTS = 128;

/// The frame in the attributes of a canon object.
struct ObjectFrame {
    Pose g5x, g92;
    double cos = 1, sin = 0;

    explicit ObjectFrame(const py::object &canon)
        : cos(canon.attr("rotation_cos").cast<double>()), sin(canon.attr("rotation_sin").cast<double>()) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            const std::string letter(1, geometry::AXIS_LETTERS_LOWER[axis]);
            g5x[axis] = canon.attr(("g5x_offset_" + letter).c_str()).cast<double>();
            g92[axis] = canon.attr(("g92_offset_" + letter).c_str()).cast<double>();
        }
    }
    Pose to_machine(Pose p) const {
        p = p + g92;
        const double x = p[0] * cos - p[1] * sin, y = p[0] * sin + p[1] * cos;
        p[0] = x;
        p[1] = y;
        return p + g5x;
    }
    Pose to_program(Pose p) const {
        p = p - g5x;
        const double x = p[0] * cos + p[1] * sin, y = p[1] * cos - p[0] * sin;
        p[0] = x;
        p[1] = y;
        return p - g92;
    }
};

py::tuple tuple_of(const Pose &p) {
    return py::make_tuple(p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]);
}

/// The sweep of the arc, positive for counterclockwise.
double sweep(double from, double to, int rotation) {
    constexpr double SAME_ANGLE = 1e-10;
    double angle = to - from;
    if (rotation > 0) {
        while (angle < SAME_ANGLE) {
            angle += FULL_TURN;
        }
        return angle + FULL_TURN * (rotation - 1);
    }
    while (angle > -SAME_ANGLE) {
        angle -= FULL_TURN;
    }
    return angle + FULL_TURN * (rotation + 1);
}

struct ArcWords {
    double first_end, second_end, first_centre, second_centre;
    int rotation;
    double axis_end;
};

/// Chords with equal angles, `max_segments` for each full circle.
py::list chords(const py::object &canon, const ArcWords &arc, const std::array<double, 6> &rest,
                int max_segments) {
    const ObjectFrame frame(canon);
    const int plane = canon.attr("plane").cast<int>();
    const int first = plane == 1 ? 0 : plane == 2 ? 1 : 2;
    const int second = plane == 1 ? 1 : plane == 2 ? 2 : 0;
    const int normal = 3 - first - second;
    const py::sequence lo = canon.attr("lo");
    Pose start;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        start[axis] = lo[static_cast<std::size_t>(axis)].cast<double>();
    }
    start = frame.to_program(start);
    Pose end;
    end[first] = arc.first_end;
    end[second] = arc.second_end;
    end[normal] = arc.axis_end;
    for (int i = 0; i < 6; ++i) {
        end[geometry::AXIS_A + i] = rest[static_cast<std::size_t>(i)];
    }
    const double x0 = start[first] - arc.first_centre, y0 = start[second] - arc.second_centre;
    const double x1 = arc.first_end - arc.first_centre, y1 = arc.second_end - arc.second_centre;
    const double from = std::atan2(y0, x0);
    const double angle = arc.rotation == 0 ? 0.0 : sweep(from, std::atan2(y1, x1), arc.rotation);
    const double r0 = std::hypot(x0, y0), r1 = std::hypot(x1, y1);
    constexpr double MOST_SEGMENTS = 1e5;
    const int count = static_cast<int>(
        std::clamp(std::ceil(std::abs(angle) / FULL_TURN * max_segments), 1.0, MOST_SEGMENTS));
    py::list out;
    for (int i = 1; i < count; ++i) {
        const double t = static_cast<double>(i) / count;
        Pose p = start + (end - start) * t;
        const double radius = r0 + (r1 - r0) * t;
        p[first] = arc.first_centre + radius * std::cos(from + angle * t);
        p[second] = arc.second_centre + radius * std::sin(from + angle * t);
        out.append(tuple_of(frame.to_machine(p)));
    }
    out.append(tuple_of(frame.to_machine(end)));
    return out;
}

/// Minimum and maximum of X, Y and Z.
struct Extents {
    static constexpr double NOTHING = 9e99;
    std::array<double, 3> lowest{NOTHING, NOTHING, NOTHING}, highest{-NOTHING, -NOTHING, -NOTHING};

    void add(const py::sequence &point, const std::array<double, 3> &offset) {
        for (std::size_t i = 0; i < lowest.size(); ++i) {
            const double value = point[i].cast<double>() + offset[i];
            lowest[i] = std::min(lowest[i], value);
            highest[i] = std::max(highest[i], value);
        }
    }
};

py::list list_of(const std::array<double, 3> &values) {
    py::list out;
    for (const double value : values) {
        out.append(value);
    }
    return out;
}

py::tuple calc_extents(const py::args &lists) {
    Extents bare, with_tool;
    for (const py::handle &list : lists) {
        for (const py::handle &item : py::reinterpret_borrow<py::sequence>(list)) {
            const auto move = py::cast<py::sequence>(item);
            const std::size_t count = move.size();
            if (count != 4 && count != 5) {
                throw py::type_error(
                    "calc_extents: an item is (line, start, end, tool offset) or (line, start, "
                    "end, feed rate, tool offset)");
            }
            const auto tool = move[count - 1].cast<py::sequence>();
            const std::array<double, 3> offset{tool[0].cast<double>(), tool[1].cast<double>(),
                                               tool[2].cast<double>()};
            for (const std::size_t end : {1U, 2U}) {
                const auto point = move[end].cast<py::sequence>();
                bare.add(point, {0, 0, 0});
                with_tool.add(point, offset);
            }
        }
    }
    return py::make_tuple(list_of(bare.lowest), list_of(bare.highest), list_of(with_tool.lowest),
                          list_of(with_tool.highest));
}

}  // namespace

void define_segments(py::module_ &module) {
    module.def(
        "arc_to_segments",
        [](const py::object &canon, double x1, double y1, double cx, double cy, int rot, double z1, double a,
           double b, double c, double u, double v, double w, int max_segments) {
            if (max_segments < 1) {
                throw py::value_error("arc_to_segments: max_segments must be at least 1");
            }
            return chords(canon, {x1, y1, cx, cy, rot, z1}, {a, b, c, u, v, w}, max_segments);
        },
        py::arg("canon"), py::arg("x1"), py::arg("y1"), py::arg("cx"), py::arg("cy"), py::arg("rot"),
        py::arg("z1"), py::arg("a"), py::arg("b"), py::arg("c"), py::arg("u"), py::arg("v"), py::arg("w"),
        py::arg("max_segments") = DEFAULT_SEGMENTS,
        "The chords of an arc_feed as a list of end points with nine coordinates, after G92, rotation and "
        "G5x.\n"
        "The canon object has: lo (where the last move ended, in the same coordinates), plane, "
        "rotation_cos,\n"
        "rotation_sin, g5x_offset_x ... g5x_offset_w, g92_offset_x ... g92_offset_w. A full turn has\n"
        "max_segments chords.");
    module.def("calc_extents", &calc_extents,
               "calc_extents(list, ...) -> (lowest, highest, lowest with tool, highest with tool)\n\n"
               "X, Y and Z of all ends of moves: tuples (line, start, end, tool offset) or with a feed rate "
               "before the tool offset; 9e99 and -9e99 when there are none.");
}

}  // namespace mw::python
