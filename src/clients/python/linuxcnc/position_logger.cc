// SPDX-License-Identifier: GPL-2.0-or-later
// linuxcnc.positionlogger: records the tool path in a thread that Python starts.
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <thread>

#include "clients/nml/remote/find_machine.hh"
#include "clients/python/linuxcnc/connection.hh"
#include "clients/python/linuxcnc/gl.hh"
#include "clients/python/linuxcnc/logged_path.hh"
#include "clients/python/linuxcnc/module.hh"
#include "clients/python/linuxcnc/view_geometry.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

constexpr std::size_t COLOURS = 6;
using Colours = std::array<Colour, COLOURS>;

Colour colour_of(const py::handle &words) {
    Colour colour{};
    const auto sequence = words.cast<py::sequence>();
    if (sequence.size() != colour.size()) {
        throw py::value_error("a colour has four numbers, 0 to 255");
    }
    for (std::size_t i = 0; i < colour.size(); ++i) {
        colour[i] = static_cast<std::uint8_t>(sequence[i].cast<int>());
    }
    return colour;
}

Colours colours_of(const py::sequence &words) {
    if (words.size() < COLOURS) {
        throw py::type_error("six colours are needed: jog, traverse, feed, arc, tool change, probe");
    }
    Colours colours;
    for (std::size_t i = 0; i < COLOURS; ++i) {
        colours[i] = colour_of(words[i]);
    }
    return colours;
}

class PositionLogger {
  public:
    PositionLogger(std::shared_ptr<ViewGeometry> view, const py::args &words) : view_(std::move(view)) {
        constexpr std::size_t GEOMETRY = 1 + COLOURS;
        if (words.size() < GEOMETRY + 1) {
            throw py::type_error("positionlogger(stat, six colours, geometry[, is_xyuv])");
        }
        colours_ = colours_of(py::sequence(words[py::slice(1, 1 + COLOURS, 1)]));
        geometry_ = words[GEOMETRY].cast<std::string>();
        is_foam_ = words.size() > GEOMETRY + 1 && words[GEOMETRY + 1].cast<int>() != 0;
    }
    PositionLogger(const PositionLogger &) = delete;
    PositionLogger &operator=(const PositionLogger &) = delete;

    /// Samples until stop(), in the calling thread. If the program ends in this time, Python ends this thread
    /// by unwinding at its next call. No destructor may run then, so gil_scoped_release is not used.
    void start(double interval_s) {
        wanted_.store(true);
        const std::string instance = machine_instance(), file = nml_file();
        PyThreadState *const python = PyEval_SaveThread();
        sample_until_stop(instance, file, interval_s);
        PyEval_RestoreThread(python);
    }
    void sample_until_stop(const std::string &instance, const std::string &file, double interval_s) {
        auto viewer = nml::find_machine(instance, file);
        while (wanted_.load()) {
            // Finds the machine again after a restart, or after a lost connection.
            if (!viewer.has_value() || !viewer->isMachineAlive()) {
                viewer = nml::find_machine(instance, file);
            } else if (viewer->read_status().has_value()) {
                sample(viewer->status());
            }
            std::this_thread::sleep_for(std::chrono::duration<double>(interval_s));
        }
    }
    void stop() { wanted_.store(false); }
    void clear() {
        const std::lock_guard lock(mutex_);
        path_.clear();
        drawn_ = 0;
    }
    std::size_t count() {
        const std::lock_guard lock(mutex_);
        return path_.points().size();
    }
    py::object last(int flag) {
        const std::lock_guard lock(mutex_);
        const std::size_t count = flag != 0 ? std::min(drawn_, path_.points().size()) : path_.points().size();
        if (count == 0) {
            return py::none();
        }
        const LoggedPoint &p = path_.points()[count - 1];
        return py::make_tuple(p.x, p.y, p.z, p.a, p.b, p.c);
    }
    void set_depth(double z, double w) {
        const std::lock_guard lock(mutex_);
        foam_z_ = static_cast<float>(z);
        foam_w_ = static_cast<float>(w);
    }
    void set_colours(const py::args &words) {
        const Colours colours =
            colours_of(words.size() == 1 ? words[0].cast<py::sequence>() : py::sequence(words));
        const std::lock_guard lock(mutex_);
        colours_ = colours;
    }
    py::tuple colours() {
        const std::lock_guard lock(mutex_);
        py::tuple out(COLOURS);
        for (std::size_t i = 0; i < COLOURS; ++i) {
            const Colour &c = colours_[i];
            out[i] = py::make_tuple(int{c[0]}, int{c[1]}, int{c[2]}, int{c[3]});
        }
        return out;
    }
    /// Draws all points into the current context of OpenGL.
    void draw() {
        const Gl &gl = Gl::library();
        const std::lock_guard lock(mutex_);
        const auto &points = path_.points();
        drawn_ = points.size();
        if (points.empty()) {
            return;
        }
        // A foam cutter's point is a line between the ends of the wire: two vertices of half the size.
        const int stride = static_cast<int>(sizeof(LoggedPoint)) / (is_foam_ ? 2 : 1);
        gl.enable_client_state(Gl::VERTEX_ARRAY);
        gl.enable_client_state(Gl::COLOR_ARRAY);
        gl.vertex_pointer(3, Gl::FLOAT, stride, &points.front().x);
        gl.color_pointer(4, Gl::UNSIGNED_BYTE, stride, points.front().colour.data());
        const int count = static_cast<int>(points.size());
        gl.draw_arrays(is_foam_ ? Gl::LINES : Gl::LINE_STRIP, 0, is_foam_ ? 2 * count : count);
        gl.disable_client_state(Gl::COLOR_ARRAY);
        gl.disable_client_state(Gl::VERTEX_ARRAY);
    }
    /// All points as bytes, which then count as drawn.
    py::tuple points() {
        const std::lock_guard lock(mutex_);
        const auto &points = path_.points();
        drawn_ = points.size();
        return py::make_tuple(
            py::bytes(reinterpret_cast<const char *>(points.data()), points.size() * sizeof(LoggedPoint)),
            points.size(), is_foam_);
    }

  private:
    void sample(const messages::MachineStatus &status) {
        const std::lock_guard lock(mutex_);
        geometry::Pose pose = status.trajectory.position_fb;
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            pose[axis] -= status.offsets.tool[axis];
        }
        const auto kind = static_cast<std::size_t>(status.trajectory.move_kind);
        LoggedPoint point;
        point.colour = point.other_colour = colours_[std::min(kind, COLOURS - 1)];
        const auto f = [](double value) { return static_cast<float>(value); };
        if (is_foam_) {
            point.x = f(pose[geometry::AXIS_X]), point.y = f(pose[geometry::AXIS_Y]), point.z = foam_z_;
            point.a = f(pose[geometry::AXIS_U]), point.b = f(pose[geometry::AXIS_V]), point.c = foam_w_;
        } else {
            const auto place = vertex_of(geometry_, pose, view_->centre());
            point.x = f(place[0]), point.y = f(place[1]), point.z = f(place[2]);
            point.a = f(pose[geometry::AXIS_A]), point.b = f(-pose[geometry::AXIS_B]),
            point.c = f(pose[geometry::AXIS_C]);
        }
        path_.add(point);
    }

    std::shared_ptr<ViewGeometry> view_;
    std::mutex mutex_;
    std::atomic<bool> wanted_{false};
    Colours colours_{};
    std::string geometry_;
    bool is_foam_ = false;
    float foam_z_ = 0, foam_w_ = 0;
    LoggedPath path_;
    std::size_t drawn_ = 0;  ///< points that the screen has received
};

}  // namespace

void define_position_logger(py::module_ &module, const std::shared_ptr<ViewGeometry> &view) {
    py::class_<PositionLogger>(module, "positionlogger",
                               "positionlogger(stat, six colours, geometry[, is_xyuv]): records where the "
                               "tool has been.")
        .def(
            py::init([view](const py::args &words) { return std::make_unique<PositionLogger>(view, words); }))
        .def("start", &PositionLogger::start, py::arg("interval"),
             "Samples every so many seconds until stop(), in the calling thread.")
        .def("stop", &PositionLogger::stop)
        .def("clear", &PositionLogger::clear)
        .def_property_readonly("npts", &PositionLogger::count)
        .def("last", &PositionLogger::last, py::arg("flag") = 1,
             "The last point that was drawn (1) or taken (0): six floats, or None.")
        .def("set_depth", &PositionLogger::set_depth, py::arg("z"), py::arg("w"))
        .def("set_colors", &PositionLogger::set_colours)
        .def("get_colors", &PositionLogger::colours)
        .def("call", &PositionLogger::draw, "Draws the path into the current context of OpenGL.")
        .def("points", &PositionLogger::points, "(bytes, count, is_xyuv): rows of 32 bytes.");
}

}  // namespace mw::python
