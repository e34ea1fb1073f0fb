// SPDX-License-Identifier: GPL-2.0-or-later
// Load of axis jogs on joints that are not axes: derivatives of the joints by the moving axes, at the
// positions that the jogs may reach, and the remaining speeds.
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
    /// Per axis: load of the other axes' curves, and of its curves with them, at `speed`.
    std::array<JointsAt, MAX_AXES> turn{};
    AxisValues speed{};
    std::array<std::array<JointsAt, MAX_AXES>, MAX_AXES> q2_here{};  ///< at the first sample, with sign
    bool isBegun = false;                                            ///< q2_here is known
    /// Of an axis that begins, at its target or nearest to it: its averaging time has to serve there as well.
    std::array<JointsAt, MAX_AXES> q1_sent{};
};

/// Part of a joint's acceleration that curves may take at maximum speed.
inline constexpr double CURVE_SHARE = 0.5;
/// Of the remaining acceleration while it brakes: derivatives have a margin of 1.05.
inline constexpr double KEPT_ALONE = 1.02;
/// A second difference below this is rounding.
inline constexpr double LEAST_CURVE = 1e-6;

/// The joint positions nearest to the current ones. False also where a pose can only be reached through a
/// singular one.
bool find_joints(const TeleopMachine &m, const geometry::Pose &pose, JointsAt &joints) noexcept;

/// A sample at distance `way` from the first along the moving axis `index`; -1: any other sample.
struct Displaced {
    int index = -1;
    double way = 0;
};
/// Adds the derivatives at one sample; false when the kinematics has no solution there.
bool add_load(const TeleopMachine &m, const geometry::Pose &pose, TeleopLoad &load,
              Displaced from = {}) noexcept;

/// Samples the target of an axis that begins, else half of the distance, and so on, a few times. A pose
/// without joint positions matters only there.
void add_sent(const TeleopMachine &m, const geometry::Pose &here, int i, double target,
              TeleopLoad &load) noexcept;

/// Speeds that the joints allow when each joint is shared evenly among `n` axes.
AxisValues shared_speeds(const TeleopMachine &m, const TeleopLoad &load, const Jogs &jogs, double n) noexcept;

/// Part of the available acceleration that an axis uses. Where several axes move joints along curves it keeps
/// a part for its stop: the other axes may reduce its share meanwhile.
double with_reserve(const TeleopLoad &load, const trajectory::AxisTrajectory &p,
                    double acceleration) noexcept;

/// True when the distance to its target is about its stopping distance with this acceleration.
bool mustBrake(const trajectory::AxisTrajectory &p, double acceleration) noexcept;

/// An axis that brakes keeps the acceleration of the last cycle if the samples, which move with it, show less
/// than before by no more than `share`. Otherwise it would pass its target.
double kept(double had, double acceleration, double share, bool isBraking) noexcept;

/// True if it can stop at or before its target with less acceleration from the next cycle on.
bool canTake(const trajectory::AxisTrajectory &p, double acceleration, double period_s) noexcept;

}  // namespace mw::motion
