// SPDX-License-Identifier: GPL-2.0-or-later
// The canon that runs a program: appends to the ordered queue, never blocks.
#pragma once

#include <string>
#include <vector>

#include "interp/machine_canon.hh"
#include "task/items.hh"

namespace mw::task {

/// Where the machine goes for a tool change ([EMCIO]TOOL_CHANGE_POSITION, TOOL_CHANGE_QUILL_UP; requirement
/// G5).
struct ToolChangePlace {
    bool isQuillRaised = false;  ///< Z to machine zero first
    int coordinates = 0;         ///< how many of `position` are given: 0, 3, 6 or 9
    geom::Pose position;         ///< [machine units], machine coordinates
};

/// Where a tool change goes from `position`, in order; empty when it stays.
std::vector<geom::Pose> tool_change_moves(const ToolChangePlace &place, const geom::Pose &position);

class TaskCanon final : public interp::MachineCanon {
  public:
    explicit TaskCanon(ItemQueue &queue, const ToolChangePlace &place = {}) : queue_(queue), place_(place) {}

    /// Blocks seen since reset(); the number of the current one.
    std::uint32_t blocks() const { return tag_.block; }
    /// The name of a file by the index in SourceTag.
    const std::string &file_name(std::uint32_t index) const { return files_[index]; }
    void reset();
    /// Where the machine is when nothing is queued.
    void set_position(const geom::Pose &position) { last_end_ = position; }

    void begin_block(const interp::BlockRef &block) override;
    void line(const interp::LineMove &move) override;
    void arc(const interp::ArcMove &move) override;
    void probe(const interp::LineMove &move, interp::ProbeKind kind) override;
    void rigid_tap(const interp::LineMove &move, double scale) override { add(RigidTapItem{move, scale}); }
    void dwell(double seconds) override { add(DwellItem{seconds}); }
    void tool_offset(const geom::Pose &offset) override { add(ToolOffsetItem{offset}); }
    void offsets(int g5x_index, const geom::Pose &g5x, const geom::Pose &g92,
                 double rotation_xy_deg) override;
    void planner_mode(bool isSmooth) override { add(PlannerModeItem{isSmooth}); }
    void set_spindle_mode(int spindle, double css_max_rpm) override {
        add(SpindleModeItem{spindle, css_max_rpm});
    }
    void set_spindle_speed(int spindle, double speed, double surface_unit) override {
        add(SpindleSpeedItem{spindle, speed, surface_unit});
    }
    void spindle_on(int spindle, int direction, bool isWaiting) override;
    void spindle_off(int spindle) override { add(SpindleOffItem{spindle}); }
    void orient_spindle(int spindle, double angle_deg, int mode) override;
    void wait_orient_complete(int spindle, double timeout_s) override {
        add(WaitOrientItem{spindle, timeout_s});
    }
    void select_tool(int toolno) override { add(SelectToolItem{toolno}); }
    void change_tool() override;
    void change_tool_number(int toolno) override { add(ChangeToolNumberItem{toolno}); }
    void set_tool_table_entry(int index, const interp::ToolEntry &entry) override {
        add(ToolEntryItem{index, entry});
    }
    void coolant(bool isMist, bool isOn) override { add(CoolantItem{isMist, isOn}); }
    void feed_override(bool isEnabled) override { add_switch(motion::Switch::FEED_OVERRIDE, 0, isEnabled); }
    void speed_override(int spindle, bool isEnabled) override;
    void feed_hold(bool isEnabled) override { add_switch(motion::Switch::FEED_HOLD, 0, isEnabled); }
    void adaptive_feed(bool isEnabled) override { add_switch(motion::Switch::ADAPTIVE_FEED, 0, isEnabled); }
    void set_digital_output(int index, bool isOn, bool isSynched) override;
    void set_analog_output(int index, double value, bool isSynched) override;
    void wait_input(int index, bool isAnalog, interp::WaitKind kind, double timeout_s) override;
    void program_stop() override { add(StopItem{false}); }
    void optional_program_stop() override { add(StopItem{true}); }
    void program_end() override { add(EndItem{true}); }
    /// The stop of M60 is a call of its own; this machine has no shuttle to move.
    void pallet_shuttle() override {}
    void finish() override { add(EndItem{false}); }
    void comment(std::string_view text) override;
    void message(std::string_view text) override;
    void print(std::string_view text) override { add(PrintItem{std::string(text)}); }
    void log_open(std::string_view path, bool isAppending) override;
    void log(std::string_view text) override { add(LogItem{LogItem::What::WRITE, std::string(text)}); }
    void log_close() override { add(LogItem{LogItem::What::CLOSE, {}}); }
    void probe_log(std::string_view path) override {
        add(LogItem{path.empty() ? LogItem::What::CLOSE : LogItem::What::OPEN, std::string(path), true});
    }
    void reload_tools() override { add(ReloadToolsItem{}); }
    void canon_error(std::string_view text) override;
    void user_m_code(int code, double p, double q) override { add(UserCodeItem{code, p, q}); }

  private:
    void add(ItemBody body) { queue_.push_back({tag_, std::move(body)}); }
    void add_switch(motion::Switch what, int spindle, bool isEnabled) {
        add(OverrideSwitchItem{what, spindle, isEnabled});
    }

    void rapid_to(const geom::Pose &end);

    ItemQueue &queue_;
    ToolChangePlace place_;
    geom::Pose last_end_{};
    motion::SourceTag tag_{};
    std::vector<std::string> files_;
};

}  // namespace mw::task
