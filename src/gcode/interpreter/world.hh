// SPDX-License-Identifier: GPL-2.0-or-later
// Queries of the interpreter to the machine. Implemented by task, by the standalone program and by tests.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "base/geometry/pose.hh"
#include "gcode/canon/canon.hh"

namespace mw::gcode {

/// The state of the machine at a synchronisation point. Lengths in machine units, machine coordinates.
struct MachineSnapshot {
    Pose position;  ///< commanded position, including the tool offset
    Pose probed_position;
    bool isProbeTripped = false;
    double input_value = 0;  ///< result of the last wait_input; -1 on timeout for digital
    bool isInputTimedOut = false;
    bool isMistOn = false, isFloodOn = false;
    bool isFeedOverrideEnabled = true, speed_override_enabled = true, isFeedHoldEnabled = true;
    bool isAdaptiveFeedEnabled = false;
    double feed_rate = 0;
    std::array<double, 8> spindle_speed{};
    std::array<int, 8> spindle_direction{};  ///< +1 cw, 0 stopped, -1 ccw
    int tool_in_spindle = 0;
    bool tool_faulted = false;  ///< the last tool change ended with a fault
    int tool_fault_reason = 0;  ///< as reported by the changer
    int selected_pocket = -1;   ///< index in the tool table of the prepared tool; -1 none
    int current_pocket = 0;     ///< index in the tool table of the tool in the spindle
};

class World {
  public:
    virtual ~World() = default;
    virtual MachineSnapshot snapshot() const = 0;
    virtual LengthUnits machine_units() const = 0;
    /// Unit of the parameter file and the tool table [mm].
    virtual double mm_per_machine_unit() const {
        constexpr double MM_PER_INCH = 25.4;
        return machine_units() == LengthUnits::MM ? 1.0 : MM_PER_INCH;
    }
    virtual unsigned axis_mask() const = 0;  ///< bit per axis, X = 1
    virtual int count_spindles() const = 0;
    virtual bool isBlockDeleteOn() const = 0;
    virtual bool isOptionalStopOn() const = 0;
    /// True if synchronisation points take no time because nothing moves (printing, checking). Scripts then
    /// continue at once.
    virtual bool isSynchedAtOnce() const { return false; }
};

/// The interpreter's view of the tool table. Entry 0 is the tool in the spindle. It has one owner: io, or the
/// standalone program.
class ToolSource {
  public:
    virtual ~ToolSource() = default;
    virtual int count() const = 0;                    ///< number of entries, including the spindle
    virtual ToolEntry entry(int index) const = 0;     ///< index in [0, count())
    virtual int index_of_tool(int toolno) const = 0;  ///< -1 when the table has no such tool
    virtual bool isRandom() const = 0;
};

/// Values for #<_ini[SECTION]KEY> and #<_hal[name]>.
class ParameterSource {
  public:
    virtual ~ParameterSource() = default;
    virtual std::optional<double> ini_value(std::string_view section, std::string_view key) const = 0;
    virtual std::optional<double> hal_value(std::string_view name) const = 0;
};

}  // namespace mw::gcode
