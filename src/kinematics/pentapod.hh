// SPDX-License-Identifier: GPL-2.0-or-later
// A pentapod (Metrom): five struts hold an effector by rings that swivel about its axis. So it has a position
// and a direction, X Y Z A B, but no rotation about its axis. Joints 0 to 4 are the lengths of the struts.
// The axis of the effector points along Ry(B) Rx(A) z. The inverse is the distance of each base joint from
// its ring (Merlet, Parallel Robots, 3.1, with the ring's nearest point as the joint); the forward kinematics
// iterates from the last pose (Newton, Merlet 4.4).
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/newton.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter PENTAPOD_PARAMETERS[] = {
    {"base.0.x", -418.03, "length", "X of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.0.y", 324.56, "length", "Y of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.0.z", 895.56, "length", "Z of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"effector.0.r", 80.32, "length", "radius of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"effector.0.z", -185.5, "length", "Z of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"base.1.x", 417.96, "length", "X of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.1.y", 324.56, "length", "Y of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.1.z", 895.56, "length", "Z of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"effector.1.r", 80.32, "length", "radius of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"effector.1.z", -159.5, "length", "Z of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"base.2.x", -418.03, "length", "X of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.2.y", -325.44, "length", "Y of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.2.z", 895.56, "length", "Z of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"effector.2.r", 80.32, "length", "radius of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"effector.2.z", -67.5, "length", "Z of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"base.3.x", 417.96, "length", "X of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.3.y", -325.44, "length", "Y of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.3.z", 895.56, "length", "Z of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"effector.3.r", 80.32, "length", "radius of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"effector.3.z", -41.5, "length", "Z of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"base.4.x", -0.06, "length", "X of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.4.y", -492.96, "length", "Y of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"base.4.z", 895.56, "length", "Z of the strut's joint at the base", PinKind::FLOAT_PARAM},
    {"effector.4.r", 80.32, "length", "radius of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"effector.4.z", -14, "length", "Z of the strut's ring on the effector", PinKind::FLOAT_PARAM},
    {"tool-offset", 0, "length", "from the effector's origin to the tip of the tool, along its axis"},
    {"convergence-criterion", 1e-9, "length", "what may be wrong with a strut's length in a solution",
     PinKind::FLOAT_IO},
    {"max-error", 100, "length", "an error of the struts above which the iteration has failed",
     PinKind::FLOAT_IO},
    {"limit-iterations", 120, "", "iterations of the forward side, at most", PinKind::U32_IO},
};

class Pentapod final : public Parametric<PENTAPOD_PARAMETERS> {
  public:
    static constexpr std::size_t STRUTS = 5;
    enum Index : std::size_t { TOOL_OFFSET = STRUTS * 5, CRITERION, MAX_ERROR, LIMIT_ITERATIONS };

    /// Finds the solution on the side of the last pose; UNREACHABLE if the iteration ends on another side.
    Status forward(const double *joints, Pose &pose) const noexcept override;
    /// As above; also returns the number of iterations.
    Status forward(const double *joints, Pose &pose, int &iterations) const noexcept;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    int side(const Pose &pose) const noexcept override;

  private:
    using Lengths = StrutLengths<STRUTS>;
    Lengths lengths_at(const Pose &pose) const noexcept;
    double size() const noexcept;
};

}  // namespace mw::kinematics
