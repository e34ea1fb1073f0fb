// SPDX-License-Identifier: GPL-2.0-or-later
// Five axes with a rotary table on a tilting table; the tool is always parallel to Z and programs use
// coordinates of the work. The position of a letter's joints is j:
//   XyzacTable: the table rotates about C on one that tilts about A:  j = o + Rx(A) (Rz(C) (p - r) - o) + r
//   XyzbcTable: the table rotates about C on one that tilts about B:  j = o + Ry(B) (Rz(C) (p - r) - o) + r
//   XyzabTable: the table rotates about A on one that rotates about B:
//               j = t + Ry(-B) (o + Rx(-A) (p - r - o) - t) + r
// r: position of the table's axis; o: offset of the second axis from it, including the tool length in Z; t:
// the tool length alone. C-H She, R-S Lee: A Postprocessor Based on the Kinematics Model for General
// Five-Axis Machine Tools (2000).
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"
#include "kinematics/trivial.hh"

namespace mw::kinematics {

inline constexpr Parameter TILTING_TABLE_PARAMETERS[] = {
    {"x-rot-point", 0, "length", "X of the table's axis in the machine"},
    {"y-rot-point", 0, "length", "Y of the table's axis in the machine"},
    {"z-rot-point", 0, "length", "Z of the table's axis in the machine"},
    {"x-offset", 0, "length", "X of the tilting axis from the table's axis"},
    {"y-offset", 0, "length", "Y of the tilting axis from the table's axis"},
    {"z-offset", 0, "length", "Z of the tilting axis from the table's face"},
    {"tool-offset", 0, "length", "length of the tool, from motion.tooloffset.z"},
};

/// TILT: the tilting axis of the lower table, A or B.
template <int TILT>
class TiltingTable final : public Parametric<TILTING_TABLE_PARAMETERS> {
    static_assert(TILT == geometry::AXIS_A || TILT == geometry::AXIS_B);

  public:
    enum Index : std::size_t { X_ROT, Y_ROT, Z_ROT, X_OFFSET, Y_OFFSET, Z_OFFSET, TOOL };

    TiltingTable() noexcept { letters_.configure(TILT == geometry::AXIS_A ? "XYZAC" : "XYZBC"); }
    /// Assigns a letter to each joint. False (and no change) if the text has other characters than axis
    /// letters.
    bool set_letters(const char *letters) noexcept { return letters_.configure(letters); }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    Vector turn_point() const noexcept { return {get(X_ROT), get(Y_ROT), get(Z_ROT)}; }
    Vector offset() const noexcept;

    Trivial letters_;
};

extern template class TiltingTable<geometry::AXIS_A>;
extern template class TiltingTable<geometry::AXIS_B>;
using XyzacTable = TiltingTable<geometry::AXIS_A>;
using XyzbcTable = TiltingTable<geometry::AXIS_B>;

inline constexpr Parameter XYZAB_TABLE_PARAMETERS[] = {
    {"tool-offset-z", 0, "length", "length of the tool, from motion.tooloffset.z"},
    {"x-offset", 0, "length", "X of the table's face from the rotation point"},
    {"z-offset", 0, "length", "Z of the axis A from the axis B"},
    {"x-rot-point", 0, "length", "X of the rotation point, on the axis B, in the machine"},
    {"y-rot-point", 0, "length", "Y of the rotation point in the machine"},
    {"z-rot-point", 0, "length", "Z of the rotation point in the machine"},
};

/// Joints 0 to 4 = X Y Z A B. `x-offset` is a shift along the axis A and has no effect.
class XyzabTable final : public Parametric<XYZAB_TABLE_PARAMETERS> {
  public:
    enum Index : std::size_t { TOOL, X_OFFSET, Z_OFFSET, X_ROT, Y_ROT, Z_ROT };
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    Vector turn_point() const noexcept { return {get(X_ROT), get(Y_ROT), get(Z_ROT)}; }
};

}  // namespace mw::kinematics
