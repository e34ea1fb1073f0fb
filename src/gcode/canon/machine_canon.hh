// SPDX-License-Identifier: GPL-2.0-or-later
// The canon in machine coordinates: actions of a program with all frames and units resolved.
#pragma once

#include <variant>

#include "base/geometry/move_settings.hh"
#include "base/geometry/pose.hh"
#include "gcode/canon/canon.hh"

namespace mw::gcode {

using geometry::MoveSettings;

struct LineMove {
    Pose end;  ///< machine coordinates
    MoveSettings settings;
};

/// A helix about `normal` through `centre`, in the XYZ (or UVW) space of machine coordinates.
struct ArcMove {
    Pose end;
    Pose centre;  ///< only the three axes of the arc's space are used
    Pose normal;  ///< unit vector; right-handed: positive angles are counterclockwise when it points to the
                  ///< viewer
    double angle_rad = 0;  ///< total signed sweep, including full revolutions
    MoveSettings settings;
};

/// Straight move until the probe trips.
struct ProbeMove {
    Pose end;  ///< machine coordinates
    MoveSettings settings;
    ProbeKind kind = ProbeKind::TOWARD_ERROR;
};

/// To `end` and back to the start, synchronised with the spindle.
struct TapMove {
    Pose end;  ///< machine coordinates
    MoveSettings settings;
    double scale = 1;  ///< speed of the return move relative to the first move
};

/// The tool offset active from now on.
struct UseToolOffset {
    Pose offset;  ///< [machine units, degrees]
};

/// The coordinate systems active from now on, for status displays.
struct UseOffsets {
    int g5x_index = 1;
    Pose g5x, g92;  ///< [machine units, degrees]
    double rotation_xy_deg = 0;
};

/// G64 R: selects planning with or without jerk limits from now on. The corner speed is in MoveSettings.
struct UsePlanner {
    bool isSmooth = false;
};

struct UseSpindleSpeed {
    int spindle = 0;
    double speed = 0;         ///< [rev/min; under constant surface speed surface units/min]
    double surface_unit = 0;  ///< length unit (metre or foot) of a surface speed [machine units]
};

using MachineVariant =
    std::variant<LineMove, ArcMove, ProbeMove, TapMove, Dwell, UseToolOffset, UseOffsets, UsePlanner,
                 SetSpindleMode, UseSpindleSpeed, StartSpindle, StopSpindle, OrientSpindle,
                 WaitOrientComplete, SelectTool, ChangeTool, ChangeToolNumber, SetToolTableEntry, ReloadTools,
                 SwitchMist, SwitchFlood, SwitchFeedOverride, SwitchSpeedOverride, SwitchFeedHold,
                 SwitchAdaptiveFeed, SetDigitalOutput, SetAnalogOutput, WaitInput, ProgramStop, ProgramEnd,
                 PalletShuttle, Finish, UserCode, ProgramComment, OperatorMessage, PrintLine, OpenLog,
                 LogLine, CloseLog, LogProbes, CanonError>;

/// One call in machine coordinates. Other calls keep their order between moves. Alternatives shared with
/// CanonCall contain nothing that depends on a frame.
class MachineCall : public MachineVariant {
  public:
    using Variant = MachineVariant;
    MachineCall();
    template <AlternativeOf<MachineVariant> Call>
    MachineCall(Call &&call)
        : MachineVariant(std::in_place_type<std::remove_cvref_t<Call>>, std::forward<Call>(call)) {}
    MachineCall(const MachineCall &other);
    MachineCall(MachineCall &&other) noexcept;
    MachineCall &operator=(const MachineCall &other);
    MachineCall &operator=(MachineCall &&other) noexcept;
    ~MachineCall();
};

/// Receives a program in machine coordinates.
class MachineCanon {
  public:
    virtual ~MachineCanon() = default;
    virtual void begin_block(const BlockRef &block) = 0;
    virtual void take(const MachineCall &call) = 0;
};

}  // namespace mw::gcode
