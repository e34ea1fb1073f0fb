// SPDX-License-Identifier: GPL-2.0-or-later
// Any arm of six rotary joints [degrees], described by modified Denavit-Hartenberg rows. The transformation
// to the next joint is ALPHA about X, A along X, then the joint's angle about Z and D along Z (Craig,
// Introduction to Robotics, 3.4). A, B and C are roll, pitch and yaw of the hand; joints 6 to 8 = U V W. The
// inverse iterates (Newton on the six equations of the pose, the Jacobian from the joints' axes: Craig 5.7)
// along a straight line from the last joint positions, so that the configuration of elbow and wrist does not
// change.
#pragma once

#include "kinematics/frame.hh"
#include "kinematics/linear_solve.hh"
#include "kinematics/parameters.hh"

namespace mw::kinematics {

inline constexpr Parameter SERIAL_PARAMETERS[] = {
    {"A-0", 0, "length", "from the axis before, along X"},
    {"ALPHA-0", 0, "rad", "turn of the axis about X"},
    {"D-0", 0, "length", "along the axis"},
    {"unrotate-0", 0, "", "no effect: there is no joint before", PinKind::S32},
    {"A-1", 0, "length", "from the axis before, along X"},
    {"ALPHA-1", -std::numbers::pi / 2, "rad", "turn of the axis about X"},
    {"D-1", 0, "length", "along the axis"},
    {"unrotate-1", 0, "", "how often the angle of joint 0 comes on top", PinKind::S32},
    {"A-2", 300, "length", "from the axis before, along X"},
    {"ALPHA-2", 0, "rad", "turn of the axis about X"},
    {"D-2", 70, "length", "along the axis"},
    {"unrotate-2", 0, "", "how often the angle of joint 1 comes on top", PinKind::S32},
    {"A-3", 50, "length", "from the axis before, along X"},
    {"ALPHA-3", -std::numbers::pi / 2, "rad", "turn of the axis about X"},
    {"D-3", 400, "length", "along the axis"},
    {"unrotate-3", 0, "", "how often the angle of joint 2 comes on top", PinKind::S32},
    {"A-4", 0, "length", "from the axis before, along X"},
    {"ALPHA-4", std::numbers::pi / 2, "rad", "turn of the axis about X"},
    {"D-4", 0, "length", "along the axis"},
    {"unrotate-4", 0, "", "how often the angle of joint 3 comes on top", PinKind::S32},
    {"A-5", 0, "length", "from the axis before, along X"},
    {"ALPHA-5", -std::numbers::pi / 2, "rad", "turn of the axis about X"},
    {"D-5", 0, "length", "along the axis"},
    {"unrotate-5", 0, "", "how often the angle of joint 4 comes on top", PinKind::S32},
    {"max-iterations", 100, "", "iterations of the inverse, at most", PinKind::U32},
};

class Serial final : public Parametric<SERIAL_PARAMETERS> {
  public:
    static constexpr std::size_t JOINTS = 6;
    enum Column : std::size_t { A, ALPHA, D, UNROTATE, COLUMNS };
    static constexpr std::size_t index_of(Column column, std::size_t joint) noexcept {
        return joint * COLUMNS + column;
    }
    static constexpr std::size_t MAX_ITERATIONS = JOINTS * COLUMNS;

    Status forward(const double *joints, Pose &pose) const noexcept override;
    Status inverse(const Pose &pose, double *joints) const noexcept override;
    /// As above; also returns the number of iterations.
    Status inverse(const Pose &pose, double *joints, int &iterations) const noexcept;

  private:
    struct Place {
        Vector point;
        Rotation turn;
    };
    struct Chain {
        std::array<Vector, JOINTS> origins, axes;
        Place hand;
    };
    Chain chain_of(const Row<JOINTS> &angles) const noexcept;
    double size() const noexcept;
    double approach(const Place &target, Row<JOINTS> &angles, double &miss) const noexcept;
    bool reach(const Place &target, Row<JOINTS> &angles, int &iterations, double &pivot) const noexcept;
    Row<JOINTS> angles_of(const double *joints) const noexcept;
};

}  // namespace mw::kinematics
