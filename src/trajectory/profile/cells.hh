// SPDX-License-Identifier: GPL-2.0-or-later
// Divides a curve into cells of about equal time, and calculates their rows.
#pragma once

#include <vector>

#include "trajectory/profile/rest_map.hh"
#include "trajectory/profile/rows.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

/// A rough profile of the speed, which determines the lengths of the cells.
class RoughProfile {
  public:
    /// Start and extent of a rough profile.
    struct Stretch {
        double from_s = 0;
        bool from_rest = false;
        double start_ramp = 0;  ///< length of the start, from standstill, over which the map is blended
        double window_s = 0;    ///< time of the window, without the time of a stop [s]
        double planned_s = 0;   ///< time of the existing cells [s]
        /// Length before the end of the run that only gets cells together with the stop.
        double end_ramp = 0;
    };
    /// End of a cell, and its approximate time.
    struct CellEnd {
        double s = 0, duration_s = 0;
    };
    /// Returns the ends of cells along the curve, without the start. The cells cover the window and a stop
    /// after it.
    const std::vector<CellEnd> &lay(const Run &run, const Stretch &stretch);
    /// Length of a start or stop at s with constant jerk, up to the full acceleration or half of the speed
    /// limit.
    static double ramp_at(const Run &run, double s) noexcept;

  private:
    static constexpr double NOWHERE = -1e300;
    struct Node {
        double s = 0, v = 0, acceleration = 0, jerk = 0, t = 0;
        double cap_s = NOWHERE;  ///< s of the cap at this node
        double ramp_s = 1e300;   ///< time A/J, in which the jerk limit builds up the maximum acceleration [s]
        double rest_s = 0;       ///< time of a start or stop with constant jerk [s]
        double curve_v = 1e300;  ///< speed at which the curve alone uses an acceleration or jerk limit
        double machine_v = 1e300;   ///< speed at the velocity limits of the axes and joints
        double velocity_s = 1e300;  ///< maximum time of a cell near these velocity limits [s]
        /// Maximum length of a cell at full use of an acceleration limit by the curvature.
        double way = 1e300;
        double cell_s = 0;  ///< time of a cell [s]
    };
    static Node node_at(const Run &run, std::size_t span, double from_s, double s) noexcept;
    void lay_nodes(const Run &run, const Stretch &stretch);
    void lay_knots(const Run &run, const Stretch &stretch);
    void size_cells(const Run &run, const Stretch &stretch);
    static void apply_velocity(Node &node, double fastest) noexcept;
    static void apply_joints(const Run &run, Node &node, double inside, double &turn_v) noexcept;
    static bool isFasterBetween(const Run &run, std::size_t span, const Node &a, const Node &b) noexcept;
    static double next_place(const Run &run, const Stretch &stretch, const Span &span, double s) noexcept;
    double speed_at(double s) const noexcept;
    static bool isInRamp(const Run &run, const Stretch &stretch, double s) noexcept;
    static bool isInEnd(const Run &run, const Stretch &stretch, double s) noexcept;
    static void apply_caps(const Run &run, Node &node, double length) noexcept;
    static double count_between(const Node &a, const Node &b, double t) noexcept;
    static double time_after(const Node &a, const Node &b, double count) noexcept;
    double count_at(double t) const noexcept;
    double time_at(double count, std::size_t &node) const noexcept;
    /// Time for which cells are needed: the window and a stop after it, without the existing cells [s].
    double time_left(const Stretch &stretch) const noexcept {
        return stretch.window_s + stop_s_ - stretch.planned_s;
    }
    void lay_between(double from, double to, std::size_t &node);
    std::vector<Node> nodes_;
    std::vector<CellEnd> knots_;
    std::vector<double> counts_;  ///< number of cells from the first node to each node
    bool reaches_end_ = false;
    double finer_ = 1;   ///< factor of the number of cells
    double stop_s_ = 0;  ///< time of a stop from the maximum speed [s]
};

/// 1 / maximum speed along the curve within the speed limits at a point.
double speed_share(const Run &run, const CurvePoint &point, std::size_t feed) noexcept;
/// The speed at which the curve alone uses an acceleration or jerk limit.
double curve_speed(const Run &run, const CurvePoint &point) noexcept;
/// The same within the velocity limits of the axes, without feed and override.
double machine_share(const Run &run, const CurvePoint &point) noexcept;
void make_rows(const Run &run, const RestMap &map, const double *knots, std::size_t cells, Rows &rows);
/// Maximum fraction of the path over which a start or a stop is blended.
inline constexpr double MAX_RAMP = 0.3;
/// The scale of the path that corresponds to this coefficient of a creep.
double creep_scale(const Run &run, double c) noexcept;
/// True if the speed changes slowly enough between two coefficients for a creep.
bool isSteady(const Run &run, double c, double next, double apart) noexcept;
/// Adds the coefficients of cells that have none. The motion is so slow that it is far within every row.
/// `end_ramp`: length before the end of the run that may later be blended into a stop. False if the last
/// coefficient is above the scale there.
bool creep(const Run &run, const RestMap &map, const std::vector<double> &knots, double end_ramp,
           std::vector<double> &c);

}  // namespace mw::trajectory::profile
