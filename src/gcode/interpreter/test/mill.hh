// SPDX-License-Identifier: GPL-2.0-or-later
// A machine in memory for the interpreter.
#pragma once

#include <string_view>
#include <vector>

#include "gcode/interpreter/world.hh"

namespace mw::gcode::test {

/// A three-axis metric mill with one spindle and a tool table in memory.
class Mill : public World, public ToolSource, public ParameterSource {
  public:
    MachineSnapshot state;
    std::vector<ToolEntry> tools{1};
    LengthUnits units = LengthUnits::MM;
    bool isBlockDelete = false;

    MachineSnapshot snapshot() const override { return state; }
    LengthUnits machine_units() const override { return units; }
    unsigned axis_mask() const override { return 0x1ff; }
    int count_spindles() const override { return 1; }
    bool isBlockDeleteOn() const override { return isBlockDelete; }
    bool isOptionalStopOn() const override { return false; }
    int count() const override { return static_cast<int>(tools.size()); }
    ToolEntry entry(int index) const override { return tools[static_cast<std::size_t>(index)]; }
    int index_of_tool(int toolno) const override {
        for (std::size_t i = 1; i < tools.size(); ++i) {
            if (tools[i].toolno == toolno) {
                return static_cast<int>(i);
            }
        }
        return -1;
    }
    bool isRandom() const override { return false; }
    std::optional<double> ini_value(std::string_view, std::string_view) const override {
        return std::nullopt;
    }
    std::optional<double> hal_value(std::string_view) const override { return std::nullopt; }
};

}  // namespace mw::gcode::test
