// SPDX-License-Identifier: GPL-2.0-or-later
// The parameter of a path between two stops. It is the length, but near a stop the length is cubic in the
// parameter. A start with constant jerk then has a constant speed along the parameter, so a stop is a regular
// point of the timing problem.
#pragma once

namespace mw::trajectory::profile {

struct MapPoint {
    double s = 0, first = 0, second = 0, third = 0;  ///< length and its derivatives by the parameter
};

class RestMap {
  public:
    /// Sets a stop at `s`, with the parameter 0. `ramp`: length of path after it over which both parameters
    /// are blended.
    void set_start(double s, double ramp) noexcept;
    /// Sets a stop at the end of the path at `s`, with the ramp before it.
    void set_end(double s, double ramp) noexcept;
    /// Removes the end. Parameters before the ramp do not change.
    void take_end_away() noexcept;
    /// Parameter at which the ramp before the end begins.
    double end_ramp() const noexcept { return end_ - stop_; }
    /// Parameter of the end.
    double end() const noexcept { return end_; }
    MapPoint at(double p) const noexcept;
    /// Length over which the map changes at p, and in a blend of the length `ramp`.
    static double scale_of(double ramp) noexcept;
    double scale_at(double p) const noexcept;
    /// The parameter at the length `s`.
    double parameter_at(double s) const noexcept;

  private:
    double start_s_ = 0, end_s_ = 1e300, start_ = 0, stop_ = 0, end_ = 1e300;
};

}  // namespace mw::trajectory::profile
