// SPDX-License-Identifier: GPL-2.0-or-later
// Joints that are axes, in the order of a word of axis letters; a letter given twice is a gantry.
#pragma once

#include "kins/kinematics.hh"

namespace mw::kins {

class Trivial final : public Kinematics {
  public:
    /// Joint n drives axis letters[n], in either case ("XYYZ"). False (and no change) for an empty or too
    /// long word or a letter that is no axis.
    bool configure(const char *letters) noexcept;
    void set_kind(Kind kind) noexcept { kind_ = kind; }

    Kind kind() const noexcept override { return kind_; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    const IdentityMap *identity() const noexcept override { return &map_; }

  private:
    IdentityMap map_;
    Kind kind_ = Kind::IDENTITY;
};

}  // namespace mw::kins
