// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are axes, in the order of a text of axis letters; a letter that occurs twice is a gantry.
#pragma once

#include "kinematics/kinematics.hh"

namespace mw::kinematics {

class Trivial final : public Kinematics {
  public:
    /// Joint n drives axis letters[n], upper or lower case ("XYYZ"). False (and no change) for an empty or
    /// too long text or a letter that is not an axis.
    bool configure(const char *letters) noexcept;

    Kind kind() const noexcept override { return Kind::IDENTITY; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    const IdentityMap *identity() const noexcept override { return &map_; }

  private:
    IdentityMap map_;
};

}  // namespace mw::kinematics
