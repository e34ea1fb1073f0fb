// SPDX-License-Identifier: GPL-2.0-or-later
#include "python/gcode/canon.hh"

#include <algorithm>

#include "interp/nurbs.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

constexpr double MM_PER_INCH = 25.4;
constexpr int MAX_TOOL_INDEX = 1000;
constexpr std::size_t BATCH_MOVES = 4096;

/// A tuple (tool number, nine offsets, diameter, front angle, back angle, orientation); what is missing is 0.
interp::ToolEntry entry_of(const py::sequence &tool) {
    interp::ToolEntry entry;
    const std::size_t count = tool.size();
    const auto number = [&](std::size_t i) { return i < count ? py::float_(tool[i]).cast<double>() : 0.0; };
    entry.toolno = static_cast<int>(number(0));
    entry.pocketno = entry.toolno;
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        entry.offset[axis] = number(static_cast<std::size_t>(axis) + 1);
    }
    entry.diameter = number(10);
    entry.frontangle = number(11);
    entry.backangle = number(12);
    entry.orientation = static_cast<int>(number(13));
    return entry;
}

}  // namespace

void PythonTools::ask(py::handle canon) {
    if (!py::hasattr(canon, "get_tool")) {
        return;
    }
    entries_.clear();
    std::size_t used = 1;
    for (int index = 0; index <= MAX_TOOL_INDEX; ++index) {
        entries_.push_back(entry_of(canon.attr("get_tool")(index)));
        used = entries_.back().toolno >= 0 ? entries_.size() : used;
    }
    entries_.resize(used);
    isRandom_ = py::hasattr(canon, "random") && py::bool_(canon.attr("random"));
}

int PythonTools::index_of_tool(int toolno) const {
    for (std::size_t i = isRandom_ ? 0 : 1; i < entries_.size(); ++i) {
        if (entries_[i].toolno == toolno) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

void PythonTools::set_entry(int index, const interp::ToolEntry &entry) {
    if (index >= 0 && static_cast<std::size_t>(index) < entries_.size()) {
        entries_[static_cast<std::size_t>(index)] = entry;
    }
}

PythonCanon::PythonCanon(py::object canon, PythonTools &tools) : canon_(std::move(canon)), tools_(tools) {
    isBatching_ = py::hasattr(canon_, "use_move_batches") && py::bool_(canon_.attr("use_move_batches")) &&
                  py::hasattr(canon_, "move_batch");
}

py::error_already_set PythonCanon::take_exception() {
    py::error_already_set taken = std::move(*exception_);
    exception_.reset();
    return taken;
}

double PythonCanon::inches(double length) const {
    return units_ == interp::LengthUnits::MM ? length / MM_PER_INCH : length;
}

interp::Pose PythonCanon::inches(const interp::Pose &pose) const {
    interp::Pose out = pose;
    for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
        out[axis] = geom::isAngular(axis) ? pose[axis] : inches(pose[axis]);
    }
    return out;
}

void PythonCanon::announce_line() {
    if (line_ == announced_line_) {
        return;
    }
    announced_line_ = line_;
    codes_.g[0] = line_;
    canon_.attr("next_line")(LineCode{codes_});
}

template <class... Args>
void PythonCanon::call(const char *name, Args &&...args) {
    if (exception_) {
        return;
    }
    try {
        finish_batch();
        announce_line();
        canon_.attr(name)(std::forward<Args>(args)...);
    } catch (py::error_already_set &error) {
        exception_.emplace(std::move(error));
    }
}

void PythonCanon::call_pose(const char *name, const interp::Pose &pose) {
    const interp::Pose p = inches(pose);
    call(name, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]);
}

/// Tuples (0 rapid or 1 feed, line, nine coordinates) for canons that take them by the thousand.
void PythonCanon::move(bool isFeed, const interp::Pose &end) {
    if (!isBatching_) {
        call_pose(isFeed ? "straight_feed" : "straight_traverse", end);
        return;
    }
    const interp::Pose p = inches(end);
    batch_.append(
        py::make_tuple(isFeed ? 1 : 0, line_, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]));
    if (batch_.size() >= BATCH_MOVES && !exception_) {
        try {
            finish_batch();
        } catch (py::error_already_set &error) {
            exception_.emplace(std::move(error));
        }
    }
}

void PythonCanon::finish_batch() {
    if (!batch_.empty()) {
        const py::list full = std::move(batch_);
        batch_ = py::list();
        canon_.attr("move_batch")(full);
    }
}

void PythonCanon::use_length_units(interp::LengthUnits units) {
    units_ = units;
}

void PythonCanon::select_plane(interp::Plane plane) {
    plane_ = plane;
    switch (plane) {
    case interp::Plane::XY: call("set_plane", 1); break;
    case interp::Plane::YZ: call("set_plane", 2); break;
    case interp::Plane::XZ: call("set_plane", 3); break;
    case interp::Plane::UV: call("set_plane", 4); break;
    case interp::Plane::VW: call("set_plane", 5); break;
    case interp::Plane::UW: call("set_plane", 6); break;
    }
}

void PythonCanon::set_g5x_offset(int index, const interp::Pose &offset) {
    const interp::Pose p = inches(offset);
    call("set_g5x_offset", index, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]);
}

void PythonCanon::set_g92_offset(const interp::Pose &offset) {
    call_pose("set_g92_offset", offset);
}

void PythonCanon::set_xy_rotation(double angle_deg) {
    call("set_xy_rotation", angle_deg);
}

void PythonCanon::use_tool_length_offset(const interp::Pose &offset) {
    call_pose("tool_offset", offset);
}

void PythonCanon::set_feed_rate(double rate) {
    call("set_feed_rate", inches(rate));
}

void PythonCanon::straight_traverse(const interp::Pose &end) {
    move(false, end);
}

void PythonCanon::straight_feed(const interp::Pose &end) {
    move(true, end);
}

void PythonCanon::arc_feed(const interp::ArcFeed &arc) {
    if (arc.rotation == 0) {
        straight_feed(arc.end);
        return;
    }
    const interp::Pose end = inches(arc.end);
    const bool isUvw =
        plane_ == interp::Plane::UV || plane_ == interp::Plane::VW || plane_ == interp::Plane::UW;
    // The three axes that the plane leaves out follow as they are; those of the arc's own space are in front.
    const int other = isUvw ? geom::AXIS_X : geom::AXIS_U;
    call("arc_feed", inches(arc.first_end), inches(arc.second_end), inches(arc.first_centre),
         inches(arc.second_centre), arc.rotation, inches(arc.axis_end), end[3], end[4], end[5], end[other],
         end[other + 1], end[other + 2]);
}

/// As straight moves and arcs that keep close to the curve.
void PythonCanon::nurbs_feed(const interp::NurbsFeed &nurbs) {
    constexpr double TOLERANCE_INCH = 0.0002;
    const bool isMm = units_ == interp::LengthUnits::MM;
    const auto pieces = approximate(nurbs, isMm ? TOLERANCE_INCH * MM_PER_INCH : TOLERANCE_INCH);
    const int first = plane_ == interp::Plane::XY ? 0 : plane_ == interp::Plane::YZ ? 1 : 2;
    const int second = plane_ == interp::Plane::XY ? 1 : plane_ == interp::Plane::YZ ? 2 : 0;
    const int normal = 3 - first - second;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        interp::Pose end = nurbs.end;
        if (i + 1 < pieces.size()) {
            end[first] = pieces[i].first_end;
            end[second] = pieces[i].second_end;
        }
        arc_feed({end[first], end[second], pieces[i].first_centre, pieces[i].second_centre,
                  pieces[i].rotation, end[normal], end});
    }
}

void PythonCanon::straight_probe(const interp::Pose &end, interp::ProbeKind) {
    call_pose("straight_probe", end);
}

void PythonCanon::rigid_tap(double x, double y, double z, double) {
    call("rigid_tap", inches(x), inches(y), inches(z));
}

void PythonCanon::dwell(double seconds) {
    call("dwell", seconds);
}

void PythonCanon::change_tool() {
    if (selected_ >= 0) {
        change_tool_number(selected_);
        selected_ = -1;
    }
}

void PythonCanon::change_tool_number(int toolno) {
    const int index = toolno == 0 ? 0 : tools_.index_of_tool(toolno);
    if (index < 0) {
        return;
    }
    if (index > 0) {
        tools_.set_entry(0, tools_.entry(index));
    } else {
        interp::ToolEntry none;
        none.toolno = 0;
        tools_.set_entry(0, none);
    }
    call("change_tool", index);
}

void PythonCanon::set_tool_table_entry(int index, const interp::ToolEntry &entry) {
    tools_.set_entry(index, entry);
}

void PythonCanon::comment(std::string_view text) {
    call("comment", py::str(text.data(), text.size()));
}

void PythonCanon::message(std::string_view text) {
    call("message", py::str(text.data(), text.size()));
}

void PythonCanon::print(std::string_view text) {
    py::print(py::str(text.data(), text.size()));
}

void PythonCanon::user_m_code(int code, double p, double q) {
    constexpr int FIRST_USER_CODE = 100;
    call("user_defined_function", code - FIRST_USER_CODE, p, q);
}

}  // namespace mw::python
