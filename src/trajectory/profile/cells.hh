// SPDX-License-Identifier: GPL-2.0-or-later
// Cells of the timing problem along a curve, about equal in time, and their rows.
#pragma once

#include <vector>

#include "trajectory/profile/rest_map.hh"
#include "trajectory/profile/rows.hh"
#include "trajectory/profile/run.hh"

namespace mw::trajectory::profile {

/// A rough profile of the speed, with which cells are laid.
class RoughProfile {
  public:
    /// Where a profile begins and how far it reaches.
    struct Stretch {
        double from_s = 0;
        bool from_rest = false;
        double start_ramp = 0;  ///< behind the start, from rest: the map is blended there
        double window_s = 0;    ///< time of the window, without that of a stop
        double planned_s = 0;   ///< time of what is laid already
        double end_ramp = 0;    ///< before the end of the run: cells reach there only together with the stop
    };
    /// End of a cell, and the time that it takes about.
    struct CellEnd {
        double s = 0, duration_s = 0;
    };
    /// Ends of cells along the curve, after the start. They cover the window and a stop behind it.
    const std::vector<CellEnd> &lay(const Run &run, const Stretch &stretch);
    /// Length of a start or stop at s with constant jerk, up to the full acceleration or half of the speed
    /// limit.
    static double ramp_at(const Run &run, double s) noexcept;

  private:
    static constexpr double NOWHERE = -1e300;
    struct Node {
        double s = 0, v = 0, acceleration = 0, jerk = 0, t = 0;
        double cap_s = NOWHERE;     ///< place of the cap that is there
        double ramp_s = 1e300;      ///< time in which the jerk limit builds up an acceleration
        double rest_s = 0;          ///< time of a start or stop with constant jerk here
        double curve_v = 1e300;     ///< speed at which the curve alone takes a limit of acceleration or jerk
        double machine_v = 1e300;   ///< at the machine's limits of velocity
        double velocity_s = 1e300;  ///< most time of a cell for the sake of these
        double way = 1e300;         ///< on which the curve changes
        double cell_s = 0;          ///< time of a cell
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
    /// Time for which cells are to be laid: the window and a stop behind it, without what is laid already.
    double time_left(const Stretch &stretch) const noexcept {
        return stretch.window_s + stop_s_ - stretch.planned_s;
    }
    void lay_between(double from, double to, std::size_t &node);
    std::vector<Node> nodes_;
    std::vector<CellEnd> knots_;
    std::vector<double> counts_;  ///< of cells from the first node to each
    bool reaches_end_ = false;
    double finer_ = 1;   ///< by which the cells are shorter
    double stop_s_ = 0;  ///< time of a stop from the maximum speed
};

/// Inverse of the maximum speed along the curve that the limits of speed allow at a point.
double speed_share(const Run &run, const CurvePoint &point, std::size_t feed) noexcept;
/// The speed at which the curve alone takes all of a limit of acceleration or jerk.
double curve_speed(const Run &run, const CurvePoint &point) noexcept;
/// The same of the machine's limits alone, without feed and override.
double machine_share(const Run &run, const CurvePoint &point) noexcept;
void make_rows(const Run &run, const RestMap &map, const double *knots, std::size_t cells, Rows &rows);
/// Largest part of the path over which a start or a stop is blended.
inline constexpr double MAX_RAMP = 0.3;
/// The scale of the path that a creep with this coefficient belongs to.
double creep_scale(const Run &run, double c) noexcept;
/// True if the speed changes slowly enough between two coefficients for a creep.
bool isSteady(const Run &run, double c, double next, double apart) noexcept;
/// Adds the coefficients of cells that have none: slow enough to keep every row by far. `end_ramp`: length
/// before the end of the run over which the map may come to be blended into a stop. False if the last one is
/// still above the scale there.
bool creep(const Run &run, const RestMap &map, const std::vector<double> &knots, double end_ramp,
           std::vector<double> &c);

}  // namespace mw::trajectory::profile
