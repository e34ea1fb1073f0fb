// SPDX-License-Identifier: GPL-2.0-or-later
// A machine that does nothing, for fuzz targets.
#pragma once

#include <optional>
#include <vector>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::fuzz {

class NullMachine : public gcode::MachineCanon,
                    public gcode::World,
                    public gcode::ToolSource,
                    public gcode::ParameterSource {
  public:
    NullMachine() {
        for (int i = 1; i <= 3; ++i) {
            gcode::ToolEntry entry;
            entry.toolno = entry.pocketno = i;
            entry.diameter = 0.5 * i;
            entry.offset[2] = i;
            tools_.push_back(entry);
        }
    }

    void begin_block(const gcode::BlockRef &) override {}
    /// The machine stops at the end of each move; all other calls are done immediately.
    void take(const gcode::MachineCall &call) override {
        if (const auto *line = std::get_if<gcode::LineMove>(&call)) {
            state_.position = line->end;
        } else if (const auto *arc = std::get_if<gcode::ArcMove>(&call)) {
            state_.position = arc->end;
        } else if (const auto *probe = std::get_if<gcode::ProbeMove>(&call)) {
            state_.position = probe->end;
        }
    }

    gcode::MachineSnapshot snapshot() const override { return state_; }
    gcode::LengthUnits machine_units() const override { return gcode::LengthUnits::MM; }
    unsigned axis_mask() const override { return 0x1ff; }
    int count_spindles() const override { return 2; }
    bool isBlockDeleteOn() const override { return false; }
    bool isOptionalStopOn() const override { return false; }
    int count() const override { return static_cast<int>(tools_.size()); }
    gcode::ToolEntry entry(int index) const override { return tools_.at(static_cast<std::size_t>(index)); }
    int index_of_tool(int toolno) const override { return toolno >= 1 && toolno < count() ? toolno : -1; }
    bool isRandom() const override { return false; }
    std::optional<double> ini_value(std::string_view, std::string_view) const override {
        return std::nullopt;
    }
    std::optional<double> hal_value(std::string_view) const override { return std::nullopt; }

  private:
    gcode::MachineSnapshot state_;
    std::vector<gcode::ToolEntry> tools_{1};
};

}  // namespace mw::fuzz
