// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/python/gcode/canon.hh"

#include <algorithm>

#include "gcode/canon/nurbs.hh"

namespace py = pybind11;

namespace mw::python {
namespace {

constexpr double MM_PER_INCH = 25.4;
constexpr int MAX_TOOL_INDEX = 1000;
constexpr std::size_t BATCH_MOVES = 4096;

/// A tuple (tool number, nine offsets, diameter, front angle, back angle, orientation); missing items are 0.
gcode::ToolEntry entry_of(const py::sequence &tool) {
    gcode::ToolEntry entry;
    const std::size_t count = tool.size();
    const auto number = [&](std::size_t i) { return i < count ? py::float_(tool[i]).cast<double>() : 0.0; };
    entry.toolno = static_cast<int>(number(0));
    entry.pocketno = entry.toolno;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
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
    random_ = py::hasattr(canon, "random") && py::bool_(canon.attr("random"));
}

int PythonTools::index_of_tool(int toolno) const {
    for (std::size_t i = random_ ? 0 : 1; i < entries_.size(); ++i) {
        if (entries_[i].toolno == toolno) {
            return static_cast<int>(i);
        }
    }
    return -1;
}

void PythonTools::set_entry(int index, const gcode::ToolEntry &entry) {
    if (index >= 0 && static_cast<std::size_t>(index) < entries_.size()) {
        entries_[static_cast<std::size_t>(index)] = entry;
    }
}

PythonCanon::PythonCanon(py::object canon, PythonTools &tools) : canon_(std::move(canon)), tools_(tools) {
    batching_ = py::hasattr(canon_, "use_move_batches") && py::bool_(canon_.attr("use_move_batches")) &&
                py::hasattr(canon_, "move_batch");
}

py::error_already_set PythonCanon::take_exception() {
    py::error_already_set taken = std::move(*exception_);
    exception_.reset();
    return taken;
}

double PythonCanon::inches(double length) const {
    return units_ == gcode::LengthUnits::MM ? length / MM_PER_INCH : length;
}

gcode::Pose PythonCanon::inches(const gcode::Pose &pose) const {
    gcode::Pose out = pose;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        out[axis] = geometry::isAngular(axis) ? pose[axis] : inches(pose[axis]);
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

void PythonCanon::call_pose(const char *name, const gcode::Pose &pose) {
    const gcode::Pose p = inches(pose);
    call(name, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]);
}

/// Tuples (0 rapid or 1 feed, line, nine coordinates), for canons that accept thousands of moves at once.
void PythonCanon::move(bool feed, const gcode::Pose &end) {
    if (!batching_) {
        call_pose(feed ? "straight_feed" : "straight_traverse", end);
        return;
    }
    const gcode::Pose p = inches(end);
    batch_.append(py::make_tuple(feed ? 1 : 0, line_, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]));
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

void PythonCanon::take(const gcode::CanonCall &call) {
    using namespace gcode;
    std::visit(
        Overloaded{
            [this](const UseLengthUnits &one) { units_ = one.units; },
            [this](const SelectTool &one) { selected_ = one.toolno; },
            [this](const SetToolTableEntry &one) { tools_.set_entry(one.index, one.entry); },
            [this](const OneOf<SelectPlane, SetG5xOffset, SetG92Offset, SetXyRotation, UseToolLengthOffset,
                               SetFeedRate, StraightTraverse, StraightFeed, ArcFeed, NurbsFeed, StraightProbe,
                               RigidTap, Dwell, ChangeTool, ChangeToolNumber, ProgramComment, OperatorMessage,
                               PrintLine, UserCode> auto &one) { hand_on(one); },
            // The object has no methods for these calls.
            [](const OneOf<OnReset, SetFeedReference, SetFeedMode, SetMotionControlMode, SetNaivecamTolerance,
                           SetPlannerMode, StartSpeedFeedSynch, StopSpeedFeedSynch, SetSpindleMode,
                           SetSpindleSpeed, StartSpindle, StopSpindle, OrientSpindle, WaitOrientComplete,
                           ReloadTools, SwitchMist, SwitchFlood, SwitchFeedOverride, SwitchSpeedOverride,
                           SwitchFeedHold, SwitchAdaptiveFeed, SetDigitalOutput, SetAnalogOutput, WaitInput,
                           ProgramStop, ProgramEnd, PalletShuttle, Finish, OpenLog, LogLine, CloseLog,
                           LogProbes, CanonError> auto &) {},
        },
        call);
}

void PythonCanon::hand_on(const gcode::SelectPlane &selected) {
    plane_ = selected.plane;
    switch (selected.plane) {
    case gcode::Plane::XY: call("set_plane", 1); break;
    case gcode::Plane::YZ: call("set_plane", 2); break;
    case gcode::Plane::XZ: call("set_plane", 3); break;
    case gcode::Plane::UV: call("set_plane", 4); break;
    case gcode::Plane::VW: call("set_plane", 5); break;
    case gcode::Plane::UW: call("set_plane", 6); break;
    }
}

void PythonCanon::hand_on(const gcode::SetG5xOffset &set) {
    const gcode::Pose p = inches(set.offset);
    call("set_g5x_offset", set.index, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]);
}

void PythonCanon::hand_on(const gcode::SetXyRotation &set) {
    call("set_xy_rotation", set.angle_deg);
}

void PythonCanon::hand_on(const gcode::SetFeedRate &set) {
    call("set_feed_rate", inches(set.rate));
}

void PythonCanon::hand_on(const gcode::ArcFeed &arc) {
    if (arc.rotation == 0) {
        move(true, arc.end);
        return;
    }
    const gcode::Pose end = inches(arc.end);
    const bool is_uvw =
        plane_ == gcode::Plane::UV || plane_ == gcode::Plane::VW || plane_ == gcode::Plane::UW;
    // The axes outside the plane follow without conversion; the axes of the arc's own space come first.
    const int other = is_uvw ? geometry::AXIS_X : geometry::AXIS_U;
    call("arc_feed", inches(arc.first_end), inches(arc.second_end), inches(arc.first_centre),
         inches(arc.second_centre), arc.rotation, inches(arc.axis_end), end[3], end[4], end[5], end[other],
         end[other + 1], end[other + 2]);
}

/// Approximates the curve by straight moves and arcs.
void PythonCanon::hand_on(const gcode::NurbsFeed &nurbs) {
    constexpr double TOLERANCE_INCH = 0.0002;
    const bool is_mm = units_ == gcode::LengthUnits::MM;
    const auto pieces = approximate(nurbs, is_mm ? TOLERANCE_INCH * MM_PER_INCH : TOLERANCE_INCH);
    const int first = plane_ == gcode::Plane::XY ? 0 : plane_ == gcode::Plane::YZ ? 1 : 2;
    const int second = plane_ == gcode::Plane::XY ? 1 : plane_ == gcode::Plane::YZ ? 2 : 0;
    const int normal = 3 - first - second;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        gcode::Pose end = nurbs.end;
        if (i + 1 < pieces.size()) {
            end[first] = pieces[i].first_end;
            end[second] = pieces[i].second_end;
        }
        hand_on(gcode::ArcFeed{end[first], end[second], pieces[i].first_centre, pieces[i].second_centre,
                               pieces[i].rotation, end[normal], end});
    }
}

void PythonCanon::hand_on(const gcode::RigidTap &tap) {
    call("rigid_tap", inches(tap.x), inches(tap.y), inches(tap.z));
}

void PythonCanon::hand_on(const gcode::Dwell &dwell) {
    call("dwell", dwell.seconds);
}

void PythonCanon::hand_on(const gcode::ChangeTool &) {
    if (selected_ >= 0) {
        hand_on(gcode::ChangeToolNumber{selected_});
        selected_ = -1;
    }
}

void PythonCanon::hand_on(const gcode::ChangeToolNumber &change) {
    const int index = change.toolno == 0 ? 0 : tools_.index_of_tool(change.toolno);
    if (index < 0) {
        return;
    }
    if (index > 0) {
        tools_.set_entry(0, tools_.entry(index));
    } else {
        gcode::ToolEntry none;
        none.toolno = 0;
        tools_.set_entry(0, none);
    }
    call("change_tool", index);
}

void PythonCanon::hand_on(const gcode::ProgramComment &comment) {
    call("comment", py::str(comment.text));
}

void PythonCanon::hand_on(const gcode::OperatorMessage &message) {
    call("message", py::str(message.text));
}

void PythonCanon::hand_on(const gcode::PrintLine &line) {
    py::print(py::str(line.text));
}

void PythonCanon::hand_on(const gcode::UserCode &user) {
    constexpr int FIRST_USER_CODE = 100;
    call("user_defined_function", user.code - FIRST_USER_CODE, user.p, user.q);
}

}  // namespace mw::python
