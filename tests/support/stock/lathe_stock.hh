// SPDX-License-Identifier: GPL-2.0-or-later
// A turned blank as a height map, cut by a pointed tool: detects rapid moves in material, deep layers and
// gouges, and measures the remaining material.
#pragma once

#include <string>

#include "tests/support/stock/contour.hh"

namespace mw::testing {

/// A move as the machine executes it.
struct StockMove {
    bool isRapid = false;
    Stroke path;
};

/// Limits for one cycle.
struct CutRules {
    double allowance = 0;  ///< allowance to be left on the contour [mm]
    double step = 1;       ///< deepest layer [mm]
    double skin = 0;  ///< allowance that earlier cycles have left on the contour; one pass may remove all of
                      ///< it [mm]
    double tolerance = 0.003;  ///< of the contour [mm]
};

class LatheStock {
  public:
    static constexpr double COLUMN = 0.01;        ///< [mm]
    static constexpr double NEAR = 0.02;          ///< width of the steepest walls [mm]
    static constexpr double DEPTH_SPARE = 0.005;  ///< of heights [mm]

    /// Material from the first point of the contour to `behind` mm after its end, up to `surface`.
    LatheStock(const Contour &contour, double surface, double behind);

    /// Moves the tool and removes the material that it contacts. Returns the fault, or an empty text.
    std::string cut(const StockMove &move, const CutRules &rules);
    double surface_at(double u) const;
    /// The position at which more than `allowance` is left on the contour, or on its envelope without
    /// pockets. Nothing when the work is complete. The last `end_allowance` mm before the contour's end do
    /// not count.
    std::string unfinished(double allowance, bool isPocketLeft, double end_allowance) const;

  private:
    double lowest_near(double u) const;
    std::string cut_to(Place from, Place to, bool isRapid, const CutRules &rules);
    bool isSkin(Place top, const CutRules &rules) const;

    const Contour &contour_;
    double surface_;
    std::vector<double> columns_;  ///< heights in the middle of each column from the first point on
};

}  // namespace mw::testing
