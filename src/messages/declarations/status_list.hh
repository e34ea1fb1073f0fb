// SPDX-License-Identifier: GPL-2.0-or-later
// All structs of the machine's status, and the tool table.
#pragma once

#include "messages/declarations/status.hh"

namespace mw::messages {

template <class... Types>
struct TypeList {};

using StatusList =
    TypeList<MachineStatus, TaskStatus, Waiting, CodesStatus, OffsetsStatus, TrajectoryStatus, ProbeStatus,
             OverridesStatus, MotionStatus, JointStatus, AxisStatus, SpindleStatus, ToolStatus, IoStatus,
             AuxStatus, CoolantStatus, LubeStatus, OperationStatus, SettingsStatus, JointSettings,
             ApproachMove, ApproachStatus, RecoveryStatus, ToolTable, ToolRecord>;

}  // namespace mw::messages
