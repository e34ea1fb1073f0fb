// SPDX-License-Identifier: GPL-2.0-or-later
// A canon object of a Python program as the interpreter's canon: lengths in inches, angles in degrees.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "interp/interpreter.hh"
#include "interp/standalone.hh"
#include "python/gcode/linecode.hh"

namespace mw::python {

/// The tools that the canon object's get_tool(index) gives, asked once at the start. Lengths in machine
/// units.
class PythonTools final : public interp::ToolSource {
  public:
    /// An exception of get_tool is left to the caller.
    void ask(pybind11::handle canon);

    int count() const override { return static_cast<int>(entries_.size()); }
    interp::ToolEntry entry(int index) const override { return entries_.at(static_cast<std::size_t>(index)); }
    int index_of_tool(int toolno) const override;
    bool isRandom() const override { return isRandom_; }

    void set_entry(int index, const interp::ToolEntry &entry);

  private:
    std::vector<interp::ToolEntry> entries_{1};
    bool isRandom_ = false;
};

/// Calls the object's methods, with next_line before the first call of each line. An exception in a method
/// keeps everything that follows from being called; take_exception() hands it over. All under the GIL.
class PythonCanon final : public interp::Canon {
  public:
    PythonCanon(pybind11::object canon, PythonTools &tools);

    /// The codes in force before the blocks that come now.
    void set_codes(const interp::ActiveCodes &codes) { codes_ = codes; }
    bool hasException() const { return exception_.has_value(); }
    pybind11::error_already_set take_exception();
    /// Hands over the moves that are still in the batch.
    void finish_batch();

    void begin_block(const interp::BlockRef &block) override { line_ = block.line; }
    void take(const interp::CanonCall &call) override;

  private:
    template <class... Args>
    void call(const char *name, Args &&...args);
    void call_pose(const char *name, const interp::Pose &pose);
    void hand_on(const interp::SelectPlane &call);
    void hand_on(const interp::SetG5xOffset &call);
    void hand_on(const interp::SetG92Offset &call) { call_pose("set_g92_offset", call.offset); }
    void hand_on(const interp::SetXyRotation &call);
    void hand_on(const interp::UseToolLengthOffset &call) { call_pose("tool_offset", call.offset); }
    void hand_on(const interp::SetFeedRate &call);
    void hand_on(const interp::StraightTraverse &call) { move(false, call.end); }
    void hand_on(const interp::StraightFeed &call) { move(true, call.end); }
    void hand_on(const interp::ArcFeed &arc);
    void hand_on(const interp::NurbsFeed &nurbs);
    void hand_on(const interp::StraightProbe &call) { call_pose("straight_probe", call.end); }
    void hand_on(const interp::RigidTap &call);
    void hand_on(const interp::Dwell &call);
    void hand_on(const interp::ChangeTool &call);
    void hand_on(const interp::ChangeToolNumber &call);
    void hand_on(const interp::ProgramComment &call);
    void hand_on(const interp::OperatorMessage &call);
    void hand_on(const interp::PrintLine &call);
    void hand_on(const interp::UserCode &call);
    void move(bool isFeed, const interp::Pose &end);
    void announce_line();
    double inches(double length) const;
    interp::Pose inches(const interp::Pose &pose) const;

    pybind11::object canon_;
    PythonTools &tools_;
    std::optional<pybind11::error_already_set> exception_;
    interp::ActiveCodes codes_;
    interp::LengthUnits units_ = interp::LengthUnits::INCH;
    interp::Plane plane_ = interp::Plane::XY;
    int line_ = 0, announced_line_ = -1;
    int selected_ = -1;
    bool isBatching_ = false;
    pybind11::list batch_;
};

}  // namespace mw::python
