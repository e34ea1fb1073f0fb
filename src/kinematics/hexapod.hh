// SPDX-License-Identifier: GPL-2.0-or-later
// A hexapod (Stewart platform): joints 0 to 5 are the lengths of six struts between base and platform. A, B
// and C are roll, pitch and yaw of the platform. The inverse is the length of each strut (Merlet, Parallel
// Robots, 3.1); the forward kinematics iterates from the last pose (Newton, Merlet 4.4). A strut with a screw
// between two cardan joints rotates when the platform tilts, which changes its length by the lead of the
// screw. `correction` accounts for this while the axes of a joint are less than 90 degrees apart.
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/newton.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter HEXAPOD_PARAMETERS[] = {
    {"base.0.x", -22.95, "length", "X of the strut's joint at the base"},
    {"base.0.y", 13.25, "length", "Y of the strut's joint at the base"},
    {"base.0.z", 0, "length", "Z of the strut's joint at the base"},
    {"platform.0.x", -1, "length", "X of the strut's joint on the platform"},
    {"platform.0.y", 11.5, "length", "Y of the strut's joint on the platform"},
    {"platform.0.z", 0, "length", "Z of the strut's joint on the platform"},
    {"base-n.0.x", 0.707107, "", "X of the direction of the joint's axis at the base"},
    {"base-n.0.y", 0, "", "Y of the direction of the joint's axis at the base"},
    {"base-n.0.z", 0.707107, "", "Z of the direction of the joint's axis at the base"},
    {"platform-n.0.x", -1, "", "X of the direction of the joint's axis on the platform"},
    {"platform-n.0.y", 0, "", "Y of the direction of the joint's axis on the platform"},
    {"platform-n.0.z", 0, "", "Z of the direction of the joint's axis on the platform"},
    {"base.1.x", 22.95, "length", "X of the strut's joint at the base"},
    {"base.1.y", 13.25, "length", "Y of the strut's joint at the base"},
    {"base.1.z", 0, "length", "Z of the strut's joint at the base"},
    {"platform.1.x", 1, "length", "X of the strut's joint on the platform"},
    {"platform.1.y", 11.5, "length", "Y of the strut's joint on the platform"},
    {"platform.1.z", 0, "length", "Z of the strut's joint on the platform"},
    {"base-n.1.x", 0, "", "X of the direction of the joint's axis at the base"},
    {"base-n.1.y", -0.707107, "", "Y of the direction of the joint's axis at the base"},
    {"base-n.1.z", 0.707107, "", "Z of the direction of the joint's axis at the base"},
    {"platform-n.1.x", 0.866025, "", "X of the direction of the joint's axis on the platform"},
    {"platform-n.1.y", 0.5, "", "Y of the direction of the joint's axis on the platform"},
    {"platform-n.1.z", 0, "", "Z of the direction of the joint's axis on the platform"},
    {"base.2.x", 22.95, "length", "X of the strut's joint at the base"},
    {"base.2.y", 13.25, "length", "Y of the strut's joint at the base"},
    {"base.2.z", 0, "length", "Z of the strut's joint at the base"},
    {"platform.2.x", 10.459, "length", "X of the strut's joint on the platform"},
    {"platform.2.y", -4.884, "length", "Y of the strut's joint on the platform"},
    {"platform.2.z", 0, "length", "Z of the strut's joint on the platform"},
    {"base-n.2.x", -0.707107, "", "X of the direction of the joint's axis at the base"},
    {"base-n.2.y", 0, "", "Y of the direction of the joint's axis at the base"},
    {"base-n.2.z", 0.707107, "", "Z of the direction of the joint's axis at the base"},
    {"platform-n.2.x", 0.866025, "", "X of the direction of the joint's axis on the platform"},
    {"platform-n.2.y", 0.5, "", "Y of the direction of the joint's axis on the platform"},
    {"platform-n.2.z", 0, "", "Z of the direction of the joint's axis on the platform"},
    {"base.3.x", 0, "length", "X of the strut's joint at the base"},
    {"base.3.y", -26.5, "length", "Y of the strut's joint at the base"},
    {"base.3.z", 0, "length", "Z of the strut's joint at the base"},
    {"platform.3.x", 9.459, "length", "X of the strut's joint on the platform"},
    {"platform.3.y", -6.616, "length", "Y of the strut's joint on the platform"},
    {"platform.3.z", 0, "length", "Z of the strut's joint on the platform"},
    {"base-n.3.x", -0.707107, "", "X of the direction of the joint's axis at the base"},
    {"base-n.3.y", 0, "", "Y of the direction of the joint's axis at the base"},
    {"base-n.3.z", 0.707107, "", "Z of the direction of the joint's axis at the base"},
    {"platform-n.3.x", 0.866025, "", "X of the direction of the joint's axis on the platform"},
    {"platform-n.3.y", -0.5, "", "Y of the direction of the joint's axis on the platform"},
    {"platform-n.3.z", 0, "", "Z of the direction of the joint's axis on the platform"},
    {"base.4.x", 0, "length", "X of the strut's joint at the base"},
    {"base.4.y", -26.5, "length", "Y of the strut's joint at the base"},
    {"base.4.z", 0, "length", "Z of the strut's joint at the base"},
    {"platform.4.x", -9.459, "length", "X of the strut's joint on the platform"},
    {"platform.4.y", -6.616, "length", "Y of the strut's joint on the platform"},
    {"platform.4.z", 0, "length", "Z of the strut's joint on the platform"},
    {"base-n.4.x", 0, "", "X of the direction of the joint's axis at the base"},
    {"base-n.4.y", 0.707107, "", "Y of the direction of the joint's axis at the base"},
    {"base-n.4.z", 0.707107, "", "Z of the direction of the joint's axis at the base"},
    {"platform-n.4.x", 0.866025, "", "X of the direction of the joint's axis on the platform"},
    {"platform-n.4.y", -0.5, "", "Y of the direction of the joint's axis on the platform"},
    {"platform-n.4.z", 0, "", "Z of the direction of the joint's axis on the platform"},
    {"base.5.x", -22.95, "length", "X of the strut's joint at the base"},
    {"base.5.y", 13.25, "length", "Y of the strut's joint at the base"},
    {"base.5.z", 0, "length", "Z of the strut's joint at the base"},
    {"platform.5.x", -10.459, "length", "X of the strut's joint on the platform"},
    {"platform.5.y", -4.884, "length", "Y of the strut's joint on the platform"},
    {"platform.5.z", 0, "length", "Z of the strut's joint on the platform"},
    {"base-n.5.x", 0.707107, "", "X of the direction of the joint's axis at the base"},
    {"base-n.5.y", 0, "", "Y of the direction of the joint's axis at the base"},
    {"base-n.5.z", 0.707107, "", "Z of the direction of the joint's axis at the base"},
    {"platform-n.5.x", -1, "", "X of the direction of the joint's axis on the platform"},
    {"platform-n.5.y", 0, "", "Y of the direction of the joint's axis on the platform"},
    {"platform-n.5.z", 0, "", "Z of the direction of the joint's axis on the platform"},
    {"spindle-offset", 0, "length", "on top of the Z of all joints: shifts the machine's origin"},
    {"tool-offset", 0, "length", "from the platform's origin to the tip of the tool, along Z"},
    {"screw-lead", 0, "length", "of the struts' screws in a turn, right-handed; 0: no correction"},
    {"convergence-criterion", 1e-9, "length", "what may be wrong with a strut's length in a solution"},
    {"max-error", 500, "length", "an error of the struts above which the iteration has failed"},
    {"limit-iterations", 120, "", "iterations of the forward side, at most", PinKind::U32},
};

class Hexapod final : public Parametric<HEXAPOD_PARAMETERS> {
  public:
    static constexpr std::size_t STRUTS = 6;
    enum Group : std::size_t { BASE, PLATFORM, BASE_AXIS, PLATFORM_AXIS, GROUPS };
    enum Index : std::size_t {
        SPINDLE_OFFSET = STRUTS * GROUPS * 3,
        TOOL_OFFSET,
        SCREW_LEAD,
        CRITERION,
        MAX_ERROR,
        LIMIT_ITERATIONS,
    };
    static constexpr std::size_t index_of(Group group, std::size_t strut) noexcept {
        return (strut * GROUPS + group) * 3;
    }

    /// Finds the solution on the side of the last pose; UNREACHABLE if the iteration ends on another side.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// As above; also returns the number of iterations.
    Status forward(const double *joints, Pose &pose, int &iterations) const noexcept;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    int side(const Pose &pose) const noexcept override;
    /// Length that the rotation of the screws adds to each strut [machine units].
    Row<STRUTS> corrections_at(const Pose &pose) const noexcept;

  private:
    struct Strut {
        Vector along;  ///< from the base to the platform
        Vector arm;    ///< from the platform's origin to its joint
        double correction = 0;
    };
    using Struts = std::array<Strut, STRUTS>;
    Vector row(Group group, std::size_t strut) const noexcept;
    Struts struts_of(const Vector &place, const Rotation &turn) const noexcept;
    double correction_of(std::size_t strut, const Vector &along, const Rotation &turn) const noexcept;
    static Square<STRUTS> derivatives_of(const Struts &struts, double rim) noexcept;
    double size() const noexcept;
};

}  // namespace mw::kinematics
