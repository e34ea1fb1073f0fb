// SPDX-License-Identifier: GPL-2.0-or-later
// The world of an interpreter without a machine: its position is the programmed position.
#pragma once

#include <functional>
#include <string>

#include "gcode/interpreter/world.hh"
#include "gcode/tools/table.hh"

namespace mw::gcode {

/// World, ToolSource and ParameterSource for `rs274` and tools that run programs without a machine.
class Standalone : public World, public ToolSource, public ParameterSource {
  public:
    using IniLookup = std::function<std::optional<double>(std::string_view section, std::string_view key)>;

    tools::Table table;
    MachineSnapshot state;
    LengthUnits units = LengthUnits::INCH;
    int spindles = 1;
    bool isBlockDelete = false;
    IniLookup ini;

    MachineSnapshot snapshot() const override { return state; }
    LengthUnits machine_units() const override { return units; }
    /// LinuxCNC's standalone interpreter uses 0.03937007874016 inch per millimetre; if a coordinate is
    /// half-way between two printed digits, the output depends on it.
    double mm_per_machine_unit() const override {
        constexpr double INCH_PER_MM = 0.03937007874016;
        return units == LengthUnits::MM ? 1.0 : 1.0 / INCH_PER_MM;
    }
    unsigned axis_mask() const override { return 0x1ff; }
    int count_spindles() const override { return spindles; }
    bool isBlockDeleteOn() const override { return isBlockDelete; }
    bool isOptionalStopOn() const override { return false; }
    bool isSynchedAtOnce() const override { return true; }

    int count() const override { return table.count(); }
    ToolEntry entry(int index) const override { return table.entry(index); }
    int index_of_tool(int toolno) const override { return table.index_of_tool(toolno); }
    bool isRandom() const override { return false; }

    std::optional<double> ini_value(std::string_view section, std::string_view key) const override {
        return ini ? ini(section, key) : std::nullopt;
    }
    std::optional<double> hal_value(std::string_view) const override { return std::nullopt; }
};

/// The three tools that exist without a tool table file [inch].
tools::Table built_in_tools();

}  // namespace mw::gcode
