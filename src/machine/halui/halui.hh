// SPDX-License-Identifier: GPL-2.0-or-later
// The operator interface as HAL pins (man page halui), declared in machine/halui/pin_tables.hh: buttons,
// wheels, jogs, lamps.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/limits.hh"
#include "base/result.hh"
#include "hal/core/user_pin_set.hh"
#include "machine/halui/halui_parts.hh"
#include "machine/halui/mdi_pins.hh"
#include "machine/halui/pin_tables.hh"
#include "messages/client/client.hh"

namespace mw::halui {

/// Settings from the INI file.
struct HaluiSettings {
    int num_joints = 3;
    int num_spindles = 1;
    unsigned axis_mask = 7;
    double units_per_mm = 1;
    double max_feed_override = 1;
    DialRange spindle_override{0, 1};
    double max_velocity = 0;                ///< [machine units/s]
    std::vector<std::string> mdi_commands;  ///< [HALUI]MDI_COMMAND, in order
};

/// A client of the machine. Buttons act on their rising edge. Not realtime; one thread.
class Halui {
  public:
    /// Creates the component "halui" and its pins.
    Result<> create(hal::Instance &hal, const HaluiSettings &settings);
    void destroy();

    /// Joins as a panel, which is independent of the right to operate of other clients.
    Result<> join(mailbox::Segment &mailbox);
    /// Converts edges to commands and states to pins. Called once in each task cycle, after task's step.
    void step();

  private:
    template <class Table>
    void make_buttons(const Table &table, int instance, int number, Result<> &status);
    void make_pins(Result<> &status);

    client::Serial ask(const messages::Command &command);
    void note_outcomes();
    void step_buttons();
    void step_jogs(std::int64_t now_ns);
    template <class Set>
    void step_selection(std::vector<Set> &sets, int &selected);
    void step_dials();
    template <class Dialled, class Make>
    void step_dial(Dialled &one, double value, const DialRange &range, Make make);
    void step_spindle(int number);
    void step_mdi();
    void show();
    void show_axes(const messages::MachineStatus &status);
    bool hasAxis(int axis) const { return ((settings_.axis_mask >> static_cast<unsigned>(axis)) & 1U) != 0; }

    HaluiSettings settings_;
    hal::Instance *hal_ = nullptr;
    std::optional<client::Client> client_;
    int comp_id_ = 0;
    int joint_ = 0, axis_ = 0;  ///< selected joint and axis
    std::vector<HaluiButton> buttons_;
    hal::UserPinSet<pins::LAMPS> lamps_;
    hal::UserPinSet<pins::JOINT_JOG_SETTINGS> joint_jog_settings_;
    hal::UserPinSet<pins::AXIS_JOG_SETTINGS> axis_jog_settings_;
    std::vector<Jogged<pins::JOINT_JOGS>> joints_;
    std::vector<Jogged<pins::AXIS_JOGS>> axes_;
    Jogged<pins::SELECTED_JOINT_JOGS> selected_joint_;
    Jogged<pins::SELECTED_AXIS_JOGS> selected_axis_;
    std::vector<hal::UserPinSet<pins::JOINT_LAMPS>> joint_lamps_;
    hal::UserPinSet<pins::SELECTED_LAMPS> selected_lamps_;
    std::array<hal::UserPinSet<pins::AXIS_LAMPS>, MAX_AXES> axis_lamps_;
    std::vector<SpindlePins> spindles_;
    Turned<pins::FEED_DIAL> feed_;
    Turned<pins::RAPID_DIAL> rapid_;
    Turned<pins::VELOCITY_DIAL> velocity_;
    std::vector<hal::UserPinSet<pins::MDI_BUTTONS>> mdi_buttons_;
    MdiPins mdi_;
    double tool_diameter_ = 0;
    std::vector<client::Serial> pending_;  ///< commands without an outcome yet
    bool rejected_ = false;
    std::uint32_t refusals_ = 0;
};

}  // namespace mw::halui
