// SPDX-License-Identifier: GPL-2.0-or-later
// Replaces the machine for a program that is interpreted without moving anything: each position is that of
// the program.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/limits.hh"
#include "gcode/canon/machine_canon.hh"
#include "gcode/interpreter/world.hh"
#include "machine/task/run/program_checksum.hh"
#include "machine/task/run/task_canon.hh"

namespace mw::task {

/// State at the position where a search has ended.
struct FoundModes {
    geometry::Pose position;  ///< position of the machine at the start of the next move
    int tool = 0;             ///< tool in the spindle
    int selected_tool = -1;   ///< tool selected by T and not loaded yet, -1: none
    bool isMistOn = false, isFloodOn = false;
    std::array<double, MAX_SPINDLES> speeds_rpm{};  ///< signed speed; 0: stopped
    std::optional<gcode::UseOffsets> offsets;
    std::optional<gcode::UseToolOffset> tool_offset;
    double feed = 0;  ///< of the last feed move [machine units/s], 0: none
    /// Calls that restore the settings, outputs and tool data of the program.
    std::vector<gcode::MachineCall> settings;
    /// Calls that start the running spindles.
    std::vector<gcode::MachineCall> spindles;
    std::vector<int> user_codes;  ///< M100 to M199 that were passed and not run
};

/// Receives the calls of a search and answers for the machine. A value known only to the running machine
/// makes everything after it unknown (a doubt). All calls come from one thread.
class SearchMachine final : public gcode::MachineCanon,
                            public gcode::World,
                            public gcode::ToolSource,
                            public gcode::ParameterSource {
  public:
    /// The real objects; all must outlive the search.
    struct Real {
        const gcode::World &world;
        const gcode::ToolSource &tools;
        const gcode::ParameterSource &parameters;
        const ToolChangePlace &tool_change_place;
        bool tool_change_with_spindle_on = false;
    };
    /// Starts with the current state of the machine.
    explicit SearchMachine(const Real &real);

    /// Applies calls before the program begins.
    void set_up(const std::vector<gcode::MachineCall> &calls);
    std::uint32_t blocks() const { return blocks_; }
    /// Checksum of all calls of the program so far.
    const ProgramChecksum &sum() const { return sum_; }
    FoundModes found() const;
    /// Changes of the program to the tool table; 0: the tool in the spindle.
    const std::map<int, gcode::ToolEntry> &tool_entries() const { return entries_; }
    /// Reason why the rest is unknown; empty: it is known.
    const std::string &doubt() const { return doubt_; }

    void begin_block(const gcode::BlockRef &) override { ++blocks_; }
    void take(const gcode::MachineCall &call) override;

    gcode::MachineSnapshot snapshot() const override { return machine_; }
    gcode::LengthUnits machine_units() const override { return real_.world.machine_units(); }
    double mm_per_machine_unit() const override { return real_.world.mm_per_machine_unit(); }
    unsigned axis_mask() const override { return real_.world.axis_mask(); }
    int count_spindles() const override { return real_.world.count_spindles(); }
    bool isBlockDeleteOn() const override { return real_.world.isBlockDeleteOn(); }
    bool isOptionalStopOn() const override { return real_.world.isOptionalStopOn(); }

    int count() const override { return real_.tools.count(); }
    gcode::ToolEntry entry(int index) const override;
    int index_of_tool(int toolno) const override { return real_.tools.index_of_tool(toolno); }
    bool isRandom() const override { return real_.tools.isRandom(); }

    std::optional<double> ini_value(std::string_view section, std::string_view key) const override {
        return real_.parameters.ini_value(section, key);
    }
    std::optional<double> hal_value(std::string_view name) const override;

  private:
    struct Spindle {
        std::optional<gcode::SetSpindleMode> mode;
        std::optional<gcode::UseSpindleSpeed> speed;
        std::optional<gcode::StartSpindle> start;
        std::optional<gcode::SwitchSpeedOverride> overriding;
    };
    Spindle &spindle(int number) { return spindles_[static_cast<std::size_t>(number)]; }
    void doubt(const std::string &what) const { doubt_ = doubt_.empty() ? what : doubt_; }
    void move_to(const geometry::Pose &end, const geometry::MoveSettings &settings);
    void change_tool();
    void set_tool_number(int toolno);
    void load(int index);
    void stop(int number);

    Real real_;
    gcode::MachineSnapshot machine_;
    std::uint32_t blocks_ = 0;
    ProgramChecksum sum_;
    mutable std::string doubt_;
    std::array<Spindle, MAX_SPINDLES> spindles_{};
    std::map<int, gcode::ToolEntry> entries_;  ///< entries that the program has changed; 0: the spindle
    int selected_tool_ = -1;
    double feed_ = 0;
    std::optional<gcode::UseOffsets> offsets_;
    std::optional<gcode::UseToolOffset> tool_offset_;
    std::optional<gcode::UsePlanner> planner_;
    std::optional<gcode::SwitchFeedOverride> feed_override_;
    std::optional<gcode::SwitchFeedHold> feed_hold_;
    std::optional<gcode::SwitchAdaptiveFeed> adaptive_;
    std::map<int, bool> digital_;
    std::map<int, double> analog_;
    std::vector<int> user_codes_;
};

}  // namespace mw::task
