// SPDX-License-Identifier: GPL-2.0-or-later
// Random turning jobs: a contour, the start of the tool, and the program that cuts the contour with G70 to
// G72.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tests/support/stock/contour.hh"

namespace mw::testing {

/// One cycle of a job.
struct JobCycle {
    std::string code;      ///< "71", "71.1", ... or "70"
    double allowance = 0;  ///< D [mm]; for G70, the allowance at the end of the contour
    double step = 0;       ///< I [mm]
    bool isPocketLeft = false;
    bool isFinishing = false;
};

struct LatheJob {
    unsigned seed = 0;
    bool isFacing = false, isInside = false, isInch = false, isDiameter = false;
    bool isMonotonic = false;  ///< the contour never falls
    bool hasArcs = false;
    Contour contour;  ///< rounding error of the numbers of the program [mm]
    Place start;      ///< of the cycles
    std::vector<JobCycle> cycles;
    std::string program;  ///< a G4 P0 before each cycle

    /// Directions of the machine's Z and X along the cut.
    Place place(double z, double x) const;
    /// From u and h to Z and X.
    void machine(Place p, double &z, double &x) const;
    /// Counterclockwise along the cut is counterclockwise from Z to X.
    bool isSameTurn() const { return (along_sign * across_sign > 0.0) != isFacing; }
    double largest_allowance() const;

    double along_sign = -1, across_sign = 1;
    double along_origin = 0, across_origin = 0;
};

LatheJob make_lathe_job(unsigned seed);

}  // namespace mw::testing
