// SPDX-License-Identifier: GPL-2.0-or-later
// Adapts a canon object of a Python program to the interpreter's canon. Lengths in inches, angles in degrees.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "clients/python/gcode/linecode.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/standalone.hh"

namespace mw::python {

/// The tools that the canon object's get_tool(index) returns, read once at the start. Lengths in machine
/// units.
class PythonTools final : public gcode::ToolSource {
  public:
    /// An exception of get_tool is passed to the caller.
    void ask(pybind11::handle canon);

    int count() const override { return static_cast<int>(entries_.size()); }
    gcode::ToolEntry entry(int index) const override { return entries_.at(static_cast<std::size_t>(index)); }
    int index_of_tool(int toolno) const override;
    bool isRandom() const override { return random_; }

    void set_entry(int index, const gcode::ToolEntry &entry);

  private:
    std::vector<gcode::ToolEntry> entries_{1};
    bool random_ = false;
};

/// Calls the object's methods, with next_line before the first call of each line. An exception in a method
/// ends all further calls; take_exception() returns it. All under the GIL.
class PythonCanon final : public gcode::Canon {
  public:
    PythonCanon(pybind11::object canon, PythonTools &tools);

    /// The modal codes before the next blocks.
    void set_codes(const gcode::ActiveCodes &codes) { codes_ = codes; }
    bool hasException() const { return exception_.has_value(); }
    pybind11::error_already_set take_exception();
    /// Passes the remaining moves of the batch.
    void finish_batch();

    void begin_block(const gcode::BlockRef &block) override { line_ = block.line; }
    void take(const gcode::CanonCall &call) override;

  private:
    template <class... Args>
    void call(const char *name, Args &&...args);
    void call_pose(const char *name, const gcode::Pose &pose);
    void hand_on(const gcode::SelectPlane &call);
    void hand_on(const gcode::SetG5xOffset &call);
    void hand_on(const gcode::SetG92Offset &call) { call_pose("set_g92_offset", call.offset); }
    void hand_on(const gcode::SetXyRotation &call);
    void hand_on(const gcode::UseToolLengthOffset &call) { call_pose("tool_offset", call.offset); }
    void hand_on(const gcode::SetFeedRate &call);
    void hand_on(const gcode::StraightTraverse &call) { move(false, call.end); }
    void hand_on(const gcode::StraightFeed &call) { move(true, call.end); }
    void hand_on(const gcode::ArcFeed &arc);
    void hand_on(const gcode::NurbsFeed &nurbs);
    void hand_on(const gcode::StraightProbe &call) { call_pose("straight_probe", call.end); }
    void hand_on(const gcode::RigidTap &call);
    void hand_on(const gcode::Dwell &call);
    void hand_on(const gcode::ChangeTool &call);
    void hand_on(const gcode::ChangeToolNumber &call);
    void hand_on(const gcode::ProgramComment &call);
    void hand_on(const gcode::OperatorMessage &call);
    void hand_on(const gcode::PrintLine &call);
    void hand_on(const gcode::UserCode &call);
    void move(bool isFeed, const gcode::Pose &end);
    void announce_line();
    double inches(double length) const;
    gcode::Pose inches(const gcode::Pose &pose) const;

    pybind11::object canon_;
    PythonTools &tools_;
    std::optional<pybind11::error_already_set> exception_;
    gcode::ActiveCodes codes_;
    gcode::LengthUnits units_ = gcode::LengthUnits::INCH;
    gcode::Plane plane_ = gcode::Plane::XY;
    int line_ = 0, announced_line_ = -1;
    int selected_ = -1;
    bool batching_ = false;
    pybind11::list batch_;
};

}  // namespace mw::python
