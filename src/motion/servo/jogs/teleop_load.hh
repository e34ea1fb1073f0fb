// SPDX-License-Identifier: GPL-2.0-or-later
// What jogs of axes ask of joints that are not axes: derivatives of the joints by the axes that move, at the
// places that the jogs may come to, and the speeds that they leave.
#pragma once

#include <array>

#include "motion/servo/jogs/teleop.hh"

namespace mw::motion {

using JointsAt = std::array<double, MAX_JOINTS>;
/// Of each axis that moves, in the order of TeleopLoad::axes.
using AxisValues = std::array<double, MAX_AXES>;

/// Largest derivatives of the joints by the axes that move.
struct TeleopLoad {
    std::array<int, MAX_AXES> axes{};
    int count = 0;
    AxisValues had{};  ///< accelerations of the last cycle
    std::array<JointsAt, MAX_AXES> q1{};
    std::array<std::array<JointsAt, MAX_AXES>, MAX_AXES> q2{};

    // With jerk limits only.
    bool isSmooth = false;
    std::array<JointsAt, MAX_AXES> q3{};  ///< by one axis alone
    /// By an axis of what the curves of the others, and theirs with it, ask at `speed`.
    std::array<JointsAt, MAX_AXES> turn{};
    AxisValues speed{};
    std::array<std::array<JointsAt, MAX_AXES>, MAX_AXES> q2_here{};  ///< at the first place, with sign
    bool isBegun = false;                                            ///< that is known
    /// Of an axis that begins, where it is sent or nearest to that: its mean is to serve it there as well.
    std::array<JointsAt, MAX_AXES> q1_sent{};
};

/// Part of a joint's acceleration that curves may take at the highest speed.
inline constexpr double CURVE_SHARE = 0.5;
/// Of what is left now, while it brakes: derivatives have a margin of 1.05.
inline constexpr double KEPT_ALONE = 1.02;
/// A second difference below this is rounding.
inline constexpr double LEAST_CURVE = 1e-6;

/// Beside where they stand. False also where only a singular pose leads.
bool find_joints(const TeleopMachine &m, const geometry::Pose &pose, JointsAt &joints) noexcept;

/// A place that is `way` along one of the axes that move from the first place; -1: any other.
struct Displaced {
    int index = -1;
    double way = 0;
};
/// Takes the derivatives at one place into account; false when the kinematics has no answer there.
bool add_load(const TeleopMachine &m, const geometry::Pose &pose, TeleopLoad &load,
              Displaced from = {}) noexcept;

/// Looks where an axis that begins is sent: there, else half of the way there, and so on, a few times;
/// nowhere else does a place without joints matter to it.
void add_sent(const TeleopMachine &m, const geometry::Pose &here, int i, double target,
              TeleopLoad &load) noexcept;

/// What joints leave of the speeds that are wanted when each is shared evenly among `n` axes.
AxisValues shared_speeds(const TeleopMachine &m, const TeleopLoad &load, const Jogs &jogs, double n) noexcept;

/// What an axis takes of the acceleration that it may have. Where several axes move joints along curves it
/// keeps a part for its stop: what others do meanwhile may leave it less than now.
double with_reserve(const TeleopLoad &load, const trajectory::AxisTrajectory &p,
                    double acceleration) noexcept;

/// It has nearly as little way left to where it is sent as this acceleration needs for its stop.
bool mustBrake(const trajectory::AxisTrajectory &p, double acceleration) noexcept;

/// Who brakes keeps the acceleration of the last cycle where the places that are looked at, which move with
/// it, show less than before by no more than `share`: else it would go beyond where it is sent.
double kept(double had, double acceleration, double share, bool isBraking) noexcept;

/// It can come to rest where it is sent, or before, with less acceleration from the next cycle on.
bool canTake(const trajectory::AxisTrajectory &p, double acceleration, double period_s) noexcept;

}  // namespace mw::motion
