// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that does nothing, for fuzz targets.
#pragma once

#include <optional>
#include <vector>

#include "interp/interpreter.hh"
#include "interp/machine_frame.hh"

namespace mw::fuzz {

class NullMachine : public interp::MachineCanon,
                    public interp::World,
                    public interp::ToolSource,
                    public interp::ParameterSource {
  public:
    NullMachine() {
        for (int i = 1; i <= 3; ++i) {
            interp::ToolEntry entry;
            entry.toolno = entry.pocketno = i;
            entry.diameter = 0.5 * i;
            entry.offset[2] = i;
            tools_.push_back(entry);
        }
    }

    void begin_block(const interp::BlockRef &) override {}
    void line(const interp::LineMove &move) override { state_.position = move.end; }
    void arc(const interp::ArcMove &move) override { state_.position = move.end; }
    void probe(const interp::LineMove &move, interp::ProbeKind) override { state_.position = move.end; }
    void rigid_tap(const interp::LineMove &, double) override {}
    void dwell(double) override {}
    void tool_offset(const interp::Pose &) override {}
    void offsets(int, const interp::Pose &, const interp::Pose &, double) override {}
    void set_spindle_mode(int, double) override {}
    void set_spindle_speed(int, double) override {}
    void spindle_on(int, int, bool) override {}
    void spindle_off(int) override {}
    void orient_spindle(int, double, int) override {}
    void wait_orient_complete(int, double) override {}
    void select_tool(int) override {}
    void change_tool() override {}
    void change_tool_number(int) override {}
    void set_tool_table_entry(int, const interp::ToolEntry &) override {}
    void coolant(bool, bool) override {}
    void feed_override(bool) override {}
    void speed_override(int, bool) override {}
    void feed_hold(bool) override {}
    void adaptive_feed(bool) override {}
    void set_digital_output(int, bool, bool) override {}
    void set_analog_output(int, double, bool) override {}
    void wait_input(int, bool, interp::WaitKind, double) override {}
    void program_stop() override {}
    void optional_program_stop() override {}
    void program_end() override {}
    void pallet_shuttle() override {}
    void finish() override {}
    void comment(std::string_view) override {}
    void message(std::string_view) override {}
    void print(std::string_view) override {}
    void log_open(std::string_view, bool) override {}
    void log(std::string_view) override {}
    void log_close() override {}
    void canon_error(std::string_view) override {}
    void user_m_code(int, double, double) override {}

    interp::MachineSnapshot snapshot() const override { return state_; }
    interp::LengthUnits machine_units() const override { return interp::LengthUnits::MM; }
    unsigned axis_mask() const override { return 0x1ff; }
    int count_spindles() const override { return 2; }
    bool isBlockDeleteOn() const override { return false; }
    bool isOptionalStopOn() const override { return false; }
    int count() const override { return static_cast<int>(tools_.size()); }
    interp::ToolEntry entry(int index) const override { return tools_.at(static_cast<std::size_t>(index)); }
    int index_of_tool(int toolno) const override { return toolno >= 1 && toolno < count() ? toolno : -1; }
    bool isRandom() const override { return false; }
    std::optional<double> ini_value(std::string_view, std::string_view) const override {
        return std::nullopt;
    }
    std::optional<double> hal_value(std::string_view) const override { return std::nullopt; }

  private:
    interp::MachineSnapshot state_;
    std::vector<interp::ToolEntry> tools_{1};
};

}  // namespace mw::fuzz
