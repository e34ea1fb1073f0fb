// SPDX-License-Identifier: GPL-2.0-or-later
// The interface of the modes of motion: free (single joints), teleop (axes) and coord (path).
#pragma once

#include <cstdint>

#include "motion/servo/parts.hh"

namespace mw::motion {

/// The first `count` joints or axes, which jogs and wheels move.
struct JogGroup {
    bool areJoints = false;
    int count = 0;
};

/// Modes have no state: they command the joints through the parts.
class MotionMode {
  public:
    /// Prepares the joints at standstill, or rejects the mode.
    [[gnu::cold]] virtual CommandResult enter(ControllerParts &parts) const noexcept = 0;
    /// One cycle while the machine is on: commands the joints.
    [[gnu::hot]] virtual void step(ControllerParts &parts, const Inputs &in) const noexcept = 0;
    /// True if joints or axes are jogged in this mode.
    virtual bool isJogging(const ControllerParts &parts) const noexcept = 0;
    virtual JogGroup jog_group(const ControllerParts &parts) const noexcept = 0;
    /// Bit per joint whose lock must be open for the moves of this mode.
    [[gnu::cold]] virtual std::uint32_t locks_wanted(const ControllerParts &parts) const noexcept = 0;

  protected:
    constexpr MotionMode() = default;
    MotionMode(const MotionMode &) = default;
    MotionMode &operator=(const MotionMode &) = default;
    ~MotionMode() = default;
};

class FreeMode final : public MotionMode {
  public:
    CommandResult enter(ControllerParts &parts) const noexcept override;
    void step(ControllerParts &parts, const Inputs &in) const noexcept override;
    bool isJogging(const ControllerParts &parts) const noexcept override;
    JogGroup jog_group(const ControllerParts &parts) const noexcept override;
    std::uint32_t locks_wanted(const ControllerParts &parts) const noexcept override;
};

class TeleopMode final : public MotionMode {
  public:
    CommandResult enter(ControllerParts &parts) const noexcept override;
    void step(ControllerParts &parts, const Inputs &in) const noexcept override;
    bool isJogging(const ControllerParts &parts) const noexcept override;
    JogGroup jog_group(const ControllerParts &parts) const noexcept override;
    std::uint32_t locks_wanted(const ControllerParts &parts) const noexcept override;
};

class CoordMode final : public MotionMode {
  public:
    CommandResult enter(ControllerParts &parts) const noexcept override;
    [[gnu::hot]] void step(ControllerParts &parts, const Inputs &in) const noexcept override;
    bool isJogging(const ControllerParts &parts) const noexcept override;
    JogGroup jog_group(const ControllerParts &parts) const noexcept override;
    std::uint32_t locks_wanted(const ControllerParts &parts) const noexcept override;
};

[[gnu::hot]] const MotionMode &motion_mode(Mode mode) noexcept;

/// True if a jog, the path, reverse run or the alignment of gantry joints moves. External offsets and extra
/// joints do not count.
[[gnu::hot]] bool isAnythingMoving(const ControllerParts &parts) noexcept;

}  // namespace mw::motion
