// SPDX-License-Identifier: GPL-2.0-or-later
// A canon object of a Python program as the interpreter's canon: lengths in inches, angles in degrees.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "interp/interpreter.hh"
#include "interp/quiet_canon.hh"
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
class PythonCanon final : public interp::QuietCanon {
  public:
    PythonCanon(pybind11::object canon, PythonTools &tools);

    /// The codes in force before the blocks that come now.
    void set_codes(const interp::ActiveCodes &codes) { codes_ = codes; }
    bool hasException() const { return exception_.has_value(); }
    pybind11::error_already_set take_exception();
    /// Hands over the moves that are still in the batch.
    void finish_batch();

    void begin_block(const interp::BlockRef &block) override { line_ = block.line; }
    void use_length_units(interp::LengthUnits units) override;
    void select_plane(interp::Plane plane) override;
    void set_g5x_offset(int index, const interp::Pose &offset) override;
    void set_g92_offset(const interp::Pose &offset) override;
    void set_xy_rotation(double angle_deg) override;
    void use_tool_length_offset(const interp::Pose &offset) override;
    void set_feed_rate(double rate) override;
    void straight_traverse(const interp::Pose &end) override;
    void straight_feed(const interp::Pose &end) override;
    void arc_feed(const interp::ArcFeed &arc) override;
    void nurbs_feed(const interp::NurbsFeed &nurbs) override;
    void straight_probe(const interp::Pose &end, interp::ProbeKind kind) override;
    void rigid_tap(double x, double y, double z, double scale) override;
    void dwell(double seconds) override;
    void select_tool(int toolno) override { selected_ = toolno; }
    void change_tool() override;
    void change_tool_number(int toolno) override;
    void set_tool_table_entry(int index, const interp::ToolEntry &entry) override;
    void comment(std::string_view text) override;
    void message(std::string_view text) override;
    void print(std::string_view text) override;
    void user_m_code(int code, double p, double q) override;

  private:
    template <class... Args>
    void call(const char *name, Args &&...args);
    void call_pose(const char *name, const interp::Pose &pose);
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
