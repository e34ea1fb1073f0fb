// SPDX-License-Identifier: GPL-2.0-or-later
// A bridge mill whose head rotates about C and tilts about B; the workpiece does not move. W moves the tool
// along its own axis. The position of a letter's joints is the value of the letter: (X Y Z) + (pivot + W)
// (direction of the tool) - (0, 0, pivot), B, C, W; A, U and V unchanged.
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"
#include "kinematics/trivial.hh"

namespace mw::kinematics {

inline constexpr Parameter BRIDGE_MILL_PARAMETERS[] = {
    {"pivot-length", 250, "length", "from the axis B to the tip of the tool at W0"},
};

class BridgeMill final : public Parametric<BRIDGE_MILL_PARAMETERS> {
  public:
    BridgeMill() noexcept { letters_.configure("XYZBCW"); }
    /// Assigns a letter to each joint. False (and no change) if the text has other characters than axis
    /// letters.
    bool set_letters(const char *letters) noexcept { return letters_.configure(letters); }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    Vector lead(const Pose &pose) const noexcept;

    Trivial letters_;
};

}  // namespace mw::kinematics
