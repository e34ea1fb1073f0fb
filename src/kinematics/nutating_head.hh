// SPDX-License-Identifier: GPL-2.0-or-later
// Six axes: a rotary table under the work, and a head that rotates about C. The head has a second axis that
// is inclined from the vertical by the nutation angle (90 degrees: an ordinary fork). Joints 0 to 5 = X Y Z A
// B C.
//   NutatingHeadOverA: the table rotates about A, the second axis is B and is inclined from Z towards Y
//   NutatingHeadOverB: the table rotates about B, the second axis is A and is inclined from Z towards X
// With all angles at 0 joints are axes. In the frame of the work the pose is the position of the tool tip on
// the work, which rotates with the table. In the frame of the tool X, Y and Z are directions of a tilted
// plane normal to the tool; the head angles of this plane are parameters, and the table has no effect:
//   work: p = r + k + T (j - r + head),   head = C (S (-l - t) - d)
//         k = d + l + t,   r = table's axis - d - l
//   tool: p = Rz(-pre-rot) (S' (C' (j + d + l) - d) - l)
// T: rotation by the table's angle; C: by the primary angle about Z; S: by the secondary angle about the
// inclined axis; ' is the inverse. l: from the spindle nose to the pivot point; d: from the second axis to
// the first; t: the tool. D. Mueller: Kinematic model for a 5axis mill with universal nutating head (2024).
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter HEAD_OVER_A_PARAMETERS[] = {
    {"tool-offset-z", 0, "length", "length of the tool, from motion.tooloffset.z"},
    {"y-rot-axis", 0, "length", "Y of the table's axis in the machine"},
    {"z-rot-axis", 0, "length", "Z of the table's axis in the machine"},
    {"y-pivot", 0, "length", "Y from the spindle's nose to the point where the axes of the head meet"},
    {"z-pivot", 0, "length", "Z from the spindle's nose to that point"},
    {"x-offset", 0, "length", "X from the axis B of the head to its axis C"},
    {"y-offset", 0, "length", "Y from the axis B of the head to its axis C"},
    {"nut-angle", 0, "degree", "how far the axis B leans from the vertical, 0 to 90"},
    {"pre-rot", 0, "radian", "type 2: by how much X of the plane is turned about the tool"},
    {"primary-angle", 0, "degree", "type 2: the angle C of the plane"},
    {"secondary-angle", 0, "degree", "type 2: the angle B of the plane"},
};

inline constexpr Parameter HEAD_OVER_B_PARAMETERS[] = {
    {"tool-offset-z", 0, "length", "length of the tool, from motion.tooloffset.z"},
    {"x-rot-axis", 0, "length", "X of the table's axis in the machine"},
    {"z-rot-axis", 0, "length", "Z of the table's axis in the machine"},
    {"x-pivot", 0, "length", "X from the spindle's nose to the point where the axes of the head meet"},
    {"z-pivot", 0, "length", "Z from the spindle's nose to that point"},
    {"x-offset", 0, "length", "X from the axis A of the head to its axis C"},
    {"y-offset", 0, "length", "Y from the axis A of the head to its axis C"},
    {"nut-angle", 0, "degree", "how far the axis A leans from the vertical, 0 to 90"},
    {"pre-rot", 0, "radian", "type 2: by how much X of the plane is turned about the tool"},
    {"primary-angle", 0, "degree", "type 2: the angle C of the plane"},
    {"secondary-angle", 0, "degree", "type 2: the angle A of the plane"},
};

/// The coordinate system of poses.
enum class HeadFrame : std::uint8_t { WORK, TOOL };

/// TABLE: the rotary axis of the table, A or B. `ROWS` is its table of parameters.
template <int TABLE, const auto &ROWS>
class NutatingHead final : public Parametric<ROWS> {
    static_assert(TABLE == geometry::AXIS_A || TABLE == geometry::AXIS_B);

  public:
    enum Index : std::size_t {
        TOOL,
        ACROSS_ROT,
        Z_ROT,
        ACROSS_PIVOT,
        Z_PIVOT,
        X_OFFSET,
        Y_OFFSET,
        NUTATION,
        PRE_ROT,
        PRIMARY,
        SECONDARY
    };

    void set_frame(HeadFrame frame) noexcept { frame_ = frame; }
    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;

  private:
    /// The second axis of the head, besides C.
    static constexpr int SECOND = TABLE == geometry::AXIS_A ? geometry::AXIS_B : geometry::AXIS_A;

    static Vector across(double length, double z) noexcept;
    Vector pivot() const noexcept { return across(this->get(ACROSS_PIVOT), this->get(Z_PIVOT)); }
    Vector offset() const noexcept { return {this->get(X_OFFSET), this->get(Y_OFFSET), 0}; }
    Vector tool() const noexcept { return {0, 0, this->get(TOOL)}; }
    /// `v` rotated by the second axis of the head.
    Vector leaned(const Vector &v, double degrees) const noexcept;
    Vector tip(double primary, double secondary) const noexcept;
    Vector table_axis() const noexcept;

    HeadFrame frame_ = HeadFrame::WORK;
};

using NutatingHeadOverA = NutatingHead<geometry::AXIS_A, HEAD_OVER_A_PARAMETERS>;
using NutatingHeadOverB = NutatingHead<geometry::AXIS_B, HEAD_OVER_B_PARAMETERS>;
extern template class NutatingHead<geometry::AXIS_A, HEAD_OVER_A_PARAMETERS>;
extern template class NutatingHead<geometry::AXIS_B, HEAD_OVER_B_PARAMETERS>;

}  // namespace mw::kinematics
