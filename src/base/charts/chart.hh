// SPDX-License-Identifier: GPL-2.0-or-later
// Charts: curves over time, one strip each, and histograms.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::charts {

struct Curve {
    std::string name;
    std::vector<double> values;  ///< one for each time
    bool digital = false;        ///< drawn as steps between 0 and 1
};

struct StripChart {
    std::string title;
    std::vector<double> times_s;
    std::vector<Curve> curves;
    /// Time of the trigger; drawn as a line if it lies within the times.
    double trigger_s = -1e300;
};

struct Histogram {
    std::string title;
    double first = 0.0;      ///< start of the first bin
    double bin_width = 1.0;  ///< [units of the values]
    std::string unit;
    std::vector<double> counts;
    double below = 0.0, above = 0.0;  ///< counts outside the bins
};

/// Round numbers that divide [low, high] into about `wanted` steps; low and high must be finite, low < high.
std::vector<double> round_ticks(double low, double high, int wanted);

/// Writes a .png or .svg file. Another extension, or a file that cannot be written, is an error.
Result<> draw_strips(const StripChart &chart, const std::string &path);
/// The histograms below each other; the axis of the counts is logarithmic.
Result<> draw_histograms(const std::vector<Histogram> &histograms, const std::string &path);

}  // namespace mw::charts
