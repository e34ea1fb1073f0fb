// SPDX-License-Identifier: GPL-2.0-or-later
// The machine as a program finds it that is interpreted without moving anything: everything is where the
// program has put it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/limits.hh"
#include "interp/canon/machine_canon.hh"
#include "interp/world.hh"
#include "task/run/call_sum.hh"
#include "task/run/task_canon.hh"

namespace mw::task {

/// What is in force at the place where a search has ended.
struct FoundModes {
    geom::Pose position;     ///< of the machine, where the next move begins
    int tool = 0;            ///< in the spindle
    int selected_tool = -1;  ///< by T and not yet changed to, -1: none
    bool isMistOn = false, isFloodOn = false;
    std::array<double, MAX_SPINDLES> speeds_rpm{};  ///< signed; 0: stands
    std::optional<interp::UseOffsets> offsets;
    std::optional<interp::UseToolOffset> tool_offset;
    double feed = 0;  ///< of the last move at feed [machine units/s], 0: none was made
    /// Settings, outputs and tool data that the program has changed, as calls that bring them about.
    std::vector<interp::MachineCall> settings;
    /// Starts the spindles that turn.
    std::vector<interp::MachineCall> spindles;
    std::vector<int> user_codes;  ///< M100 to M199 that were passed and not run
};

/// Takes the calls of a search and answers for the machine. Values that only the running machine knows are
/// doubts: what comes behind them is not known. One thread.
class SearchMachine final : public interp::MachineCanon,
                            public interp::World,
                            public interp::ToolSource,
                            public interp::ParameterSource {
  public:
    /// The real ones; all must outlive it.
    struct Real {
        const interp::World &world;
        const interp::ToolSource &tools;
        const interp::ParameterSource &parameters;
        const ToolChangePlace &tool_change_place;
        bool isToolChangeWithSpindleOn = false;
    };
    /// The search begins with the machine as it is.
    explicit SearchMachine(const Real &real);

    /// What holds before the program begins.
    void set_up(const std::vector<interp::MachineCall> &calls);
    std::uint32_t blocks() const { return blocks_; }
    /// Of all calls of the program so far.
    const CallSum &sum() const { return sum_; }
    FoundModes found() const;
    /// Of the tool table, what the program has changed; 0: what is in the spindle.
    const std::map<int, interp::ToolEntry> &tool_entries() const { return entries_; }
    /// What has made the rest unknown; empty: nothing.
    const std::string &doubt() const { return doubt_; }

    void begin_block(const interp::BlockRef &) override { ++blocks_; }
    void take(const interp::MachineCall &call) override;

    interp::MachineSnapshot snapshot() const override { return machine_; }
    interp::LengthUnits machine_units() const override { return real_.world.machine_units(); }
    double mm_per_machine_unit() const override { return real_.world.mm_per_machine_unit(); }
    unsigned axis_mask() const override { return real_.world.axis_mask(); }
    int count_spindles() const override { return real_.world.count_spindles(); }
    bool isBlockDeleteOn() const override { return real_.world.isBlockDeleteOn(); }
    bool isOptionalStopOn() const override { return real_.world.isOptionalStopOn(); }

    int count() const override { return real_.tools.count(); }
    interp::ToolEntry entry(int index) const override;
    int index_of_tool(int toolno) const override { return real_.tools.index_of_tool(toolno); }
    bool isRandom() const override { return real_.tools.isRandom(); }

    std::optional<double> ini_value(std::string_view section, std::string_view key) const override {
        return real_.parameters.ini_value(section, key);
    }
    std::optional<double> hal_value(std::string_view name) const override;

  private:
    struct Spindle {
        std::optional<interp::SetSpindleMode> mode;
        std::optional<interp::UseSpindleSpeed> speed;
        std::optional<interp::StartSpindle> start;
        std::optional<interp::SwitchSpeedOverride> overriding;
    };
    Spindle &spindle(int number) { return spindles_[static_cast<std::size_t>(number)]; }
    void doubt(const std::string &what) const { doubt_ = doubt_.empty() ? what : doubt_; }
    void move_to(const geom::Pose &end, const geom::MoveSettings &settings);
    void change_tool();
    void set_tool_number(int toolno);
    void load(int index);
    void stop(int number);

    Real real_;
    interp::MachineSnapshot machine_;
    std::uint32_t blocks_ = 0;
    CallSum sum_;
    mutable std::string doubt_;
    std::array<Spindle, MAX_SPINDLES> spindles_{};
    std::map<int, interp::ToolEntry> entries_;  ///< that the program has changed; 0: the spindle's
    int selected_tool_ = -1;
    double feed_ = 0;
    std::optional<interp::UseOffsets> offsets_;
    std::optional<interp::UseToolOffset> tool_offset_;
    std::optional<interp::UsePlanner> planner_;
    std::optional<interp::SwitchFeedOverride> feed_override_;
    std::optional<interp::SwitchFeedHold> feed_hold_;
    std::optional<interp::SwitchAdaptiveFeed> adaptive_;
    std::map<int, bool> digital_;
    std::map<int, double> analog_;
    std::vector<int> user_codes_;
};

}  // namespace mw::task
