// SPDX-License-Identifier: GPL-2.0-or-later
// The complete state at the start of a program, stored so that it can be calculated again after a power cut.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "gcode/canon/machine_canon.hh"
#include "gcode/interpreter/world.hh"
#include "machine/task/run/search_machine.hh"

namespace mw::task {

struct StartRecord {
    std::string interpreter;  ///< Interpreter::pack_state()
    std::string frame;        ///< MachineFrame::pack()
    gcode::MachineSnapshot machine;
    bool isBlockDelete = true, isOptionalStop = true;
    bool confined = false;  ///< the run had only the authority to operate
    std::vector<gcode::ToolEntry> tools;
    gcode::UseOffsets offsets;
    gcode::UseToolOffset tool_offset;
    std::vector<gcode::SetSpindleMode> spindle_modes;  ///< settings of running spindles, and so on
    std::vector<gcode::UseSpindleSpeed> spindle_speeds;
    std::vector<gcode::StartSpindle> spindle_starts;
    std::uint64_t digital_out = 0;
    std::vector<double> analog_out;

    /// Adds running spindles, from ProgramSpindles::starts().
    void add_spindles(const std::vector<gcode::MachineCall> &starts);
    /// Calls that restore the recorded state on a machine that was just started.
    std::vector<gcode::MachineCall> calls() const;

    std::string pack() const;
    static std::optional<StartRecord> unpack(std::string_view bytes);
};

/// The machine as it was at the start of a program, on a machine that was restarted later.
class RecordedWorld final : public gcode::World, public gcode::ToolSource {
  public:
    struct Real {
        const gcode::World &world;
        const gcode::ToolSource &tools;
    };
    RecordedWorld(const Real &real, StartRecord record) : real_(real), record_(std::move(record)) {}
    const StartRecord &record() const { return record_; }

    gcode::MachineSnapshot snapshot() const override { return record_.machine; }
    gcode::LengthUnits machine_units() const override { return real_.world.machine_units(); }
    double mm_per_machine_unit() const override { return real_.world.mm_per_machine_unit(); }
    unsigned axis_mask() const override { return real_.world.axis_mask(); }
    int count_spindles() const override { return real_.world.count_spindles(); }
    bool isBlockDeleteOn() const override { return record_.isBlockDelete; }
    bool isOptionalStopOn() const override { return record_.isOptionalStop; }

    int count() const override { return static_cast<int>(record_.tools.size()); }
    gcode::ToolEntry entry(int index) const override {
        return record_.tools[static_cast<std::size_t>(index)];
    }
    int index_of_tool(int toolno) const override;
    bool isRandom() const override { return real_.tools.isRandom(); }

  private:
    Real real_;
    StartRecord record_;
};

/// The same start with the current tools in `tools`. `found`: state at the position where the program
/// continues. Rejected when the tool table has other tools, or the program itself has set changed data.
Result<StartRecord> with_tools_now(StartRecord record, const FoundModes &found,
                                   const gcode::ToolSource &tools);

/// Checksum of all entries except the copy of the tool in the spindle.
std::uint64_t sum_of_tools(const gcode::ToolSource &tools);

}  // namespace mw::task
