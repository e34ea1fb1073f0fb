// SPDX-License-Identifier: GPL-2.0-or-later
// The drawing functions of the module linuxcnc: draw paths of programs into the current OpenGL context.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include "clients/python/linuxcnc/gl.hh"
#include "clients/python/linuxcnc/module.hh"
#include "clients/python/linuxcnc/view_geometry.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

/// Half the size of the cross for a dwell.
constexpr double DWELL_SIZE = 0.015625;

geometry::Pose pose_of(const py::handle &words) {
    const auto sequence = py::reinterpret_steal<py::object>(
        PySequence_Fast(words.ptr(), "a place is a sequence of nine numbers"));
    if (!sequence) {
        throw py::error_already_set();
    }
    if (PySequence_Fast_GET_SIZE(sequence.ptr()) != geometry::AXIS_COUNT) {
        throw py::type_error("a place is a sequence of nine numbers");
    }
    PyObject *const *const items = PySequence_Fast_ITEMS(sequence.ptr());
    geometry::Pose pose;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        pose[axis] = PyFloat_AsDouble(items[axis]);
    }
    if (PyErr_Occurred() != nullptr) {
        throw py::error_already_set();
    }
    return pose;
}

/// One item of a list: (line, number or position, ...).
py::tuple item_of(const py::handle &words, std::size_t least) {
    auto item = words.cast<py::tuple>();
    if (item.size() < least) {
        throw py::type_error("an item of the list has too few values");
    }
    return item;
}

unsigned line_of(const py::tuple &item) {
    return static_cast<unsigned>(item[0].cast<long>());
}

class Drawing {
  public:
    Drawing(const std::string &geometry, RotationCentre rotation)
        : gl_(Gl::library()), geometry_(geometry), rotation_(rotation) {}

    void point(const geometry::Pose &pose) const { gl_.vertex(vertex_of(geometry_, pose, rotation_).data()); }

    /// Number of straight pieces for a move: one if there is no rotation.
    static int pieces(const geometry::Pose &from, const geometry::Pose &to) {
        constexpr int LEAST = 10;
        constexpr double DEGREES = 10;
        double most = 0;
        for (const int axis : {geometry::AXIS_A, geometry::AXIS_B, geometry::AXIS_C}) {
            most = std::max(most, std::abs(to[axis] - from[axis]));
        }
        constexpr double LIMIT = 10000;  // [deg]: limits the number of lines for a move of many revolutions
        return most == 0 ? 1 : std::max(LEAST, static_cast<int>(std::ceil(std::min(most / DEGREES, LIMIT))));
    }

    /// Draws all points except the first one, in a strip.
    void move(const geometry::Pose &from, const geometry::Pose &to) const {
        const int count = pieces(from, to);
        for (int i = 1; i < count; ++i) {
            point(between(from, to, static_cast<double>(i) / count));
        }
        point(to);
    }

    /// Draws pairs of points, as GL_LINES.
    void separate_move(const geometry::Pose &from, const geometry::Pose &to) const {
        const int count = pieces(from, to);
        for (int i = 0; i < count; ++i) {
            point(between(from, to, static_cast<double>(i) / count));
            point(i + 1 == count ? to : between(from, to, static_cast<double>(i + 1) / count));
        }
    }

  private:
    static geometry::Pose between(const geometry::Pose &from, const geometry::Pose &to, double part) {
        geometry::Pose pose;
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            pose[axis] = from[axis] + (to[axis] - from[axis]) * part;
        }
        return pose;
    }

    const Gl &gl_;
    const std::string &geometry_;
    RotationCentre rotation_;
};

/// Calls glBegin, and glEnd at the end of its scope.
class Strip {
  public:
    explicit Strip(const Gl &gl) : gl_(gl) {}
    ~Strip() { end(); }
    Strip(const Strip &) = delete;
    Strip &operator=(const Strip &) = delete;
    void begin(unsigned mode) {
        end();
        gl_.begin(mode);
        is_open_ = true;
    }
    void end() {
        if (is_open_) {
            gl_.end();
        }
        is_open_ = false;
    }
    bool isOpen() const { return is_open_; }

  private:
    const Gl &gl_;
    bool is_open_ = false;
};

void draw_lines(const Drawing &drawing, const py::list &lines, bool selecting) {
    const Gl &gl = Gl::library();
    Strip strip(gl);
    geometry::Pose last;
    long last_line = -1;
    for (const py::handle words : lines) {
        const py::tuple item = item_of(words, 3);
        const long line = static_cast<long>(line_of(item));
        const geometry::Pose from = pose_of(item[1]), to = pose_of(item[2]);
        const bool new_line = selecting && line != last_line;
        if (!strip.isOpen() || new_line || !(from == last)) {
            strip.end();
            if (new_line) {
                gl.load_name(static_cast<unsigned>(line));
            }
            strip.begin(Gl::LINE_STRIP);
            drawing.point(from);
        }
        drawing.move(from, to);
        last = to;
        last_line = line;
    }
}

/// A cross in the plane normal to the axis `normal`.
void draw_cross(const Gl &gl, const Vertex &at, std::size_t normal) {
    const std::size_t first = normal == 0 ? 1 : 0, second = normal == 2 ? 1 : 2;
    for (const double sense : {1.0, -1.0}) {
        for (const double end : {-1.0, 1.0}) {
            Vertex corner = at;
            corner[first] += end * DWELL_SIZE;
            corner[second] += end * sense * DWELL_SIZE;
            gl.vertex(corner.data());
        }
    }
}

void draw_dwells(const py::list &dwells, double alpha, bool selecting, bool is_lathe) {
    const Gl &gl = Gl::library();
    Strip strip(gl);
    // Normals of the planes XY, XZ and YZ.
    constexpr std::array<std::size_t, 3> NORMALS{2, 1, 0};
    for (const py::handle words : dwells) {
        const py::tuple item = item_of(words, 6);
        const auto colour = item[1].cast<std::array<double, 3>>();
        const Vertex at{item[2].cast<double>(), item[3].cast<double>(), item[4].cast<double>()};
        const auto plane = static_cast<std::size_t>(is_lathe ? 1 : std::clamp(item[5].cast<int>(), 0, 2));
        if (selecting) {
            strip.end();
            gl.load_name(line_of(item));
        } else {
            const auto f = [](double value) { return static_cast<float>(value); };
            gl.color(std::array{f(colour[0]), f(colour[1]), f(colour[2]), f(alpha)}.data());
        }
        if (!strip.isOpen()) {
            strip.begin(Gl::LINES);
        }
        draw_cross(gl, at, NORMALS[plane]);
    }
}

}  // namespace

void define_drawing(py::module_ &module, const std::shared_ptr<ViewGeometry> &view) {
    module.def(
        "draw_lines",
        [view](const std::string &geometry, const py::list &lines, bool selecting) {
            draw_lines(Drawing(geometry, view->centre()), lines, selecting);
        },
        py::arg("geometry"), py::arg("lines"), py::arg("for_selection") = false,
        "Draws moves: items (line, nine coordinates of the start, nine of the end, ...).");
    module.def(
        "draw_dwells",
        [](const std::string &, const py::list &dwells, double alpha, bool selecting, bool is_lathe) {
            draw_dwells(dwells, alpha, selecting, is_lathe);
        },
        py::arg("geometry"), py::arg("dwells"), py::arg("alpha"), py::arg("for_selection") = false,
        py::arg("is_lathe") = false,
        "Draws a cross for each: items (line, (r, g, b), x, y, z, plane 0 XY 1 XZ 2 YZ).");
    module.def(
        "line9",
        [view](const std::string &geometry, const py::object &from, const py::object &to) {
            Drawing(geometry, view->centre()).separate_move(pose_of(from), pose_of(to));
        },
        py::arg("geometry"), py::arg("start"), py::arg("end"),
        "The vertices of one move, within a glBegin(GL_LINES).");
    module.def(
        "vertex9",
        [view](const std::string &geometry, const py::object &pose) {
            const Vertex place = vertex_of(geometry, pose_of(pose), view->centre());
            return py::make_tuple(place[0], place[1], place[2]);
        },
        py::arg("geometry"), py::arg("pose"), "(x, y, z) in the picture of nine coordinates.");
    module.def(
        "gui_rot_offsets", [view](double x, double y, double z) { view->place_origin({x, y, z}); },
        py::arg("x"), py::arg("y"), py::arg("z"), "Where the origin of the work piece is.");
    module.def(
        "gui_respect_offsets",
        [view](const std::string &coordinates, int flag) { view->choose(coordinates, flag != 0); },
        py::arg("coordinates"), py::arg("flag"),
        "Which letters there are, and whether they turn about the origin of the work piece (1) or of the "
        "machine (0).");
}

}  // namespace mw::python
