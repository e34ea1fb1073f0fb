// SPDX-License-Identifier: GPL-2.0-or-later
// Checks a stream of commanded positions against limits of speed, acceleration and jerk, by differences of
// the samples. The bound is the limit * (1 + relative) plus the effect of the rounding of positions on the
// differences.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace mw::testing {

struct AxisLimit {
    double velocity = 1e300;
    double acceleration = 1e300;
    double jerk = 1e300;
};

/// Reads one row of positions per period; `worst` and `report` give the largest ratio to the limits and the
/// violations.
class LimitChecker {
  public:
    LimitChecker(std::vector<AxisLimit> limits, double period_s, double relative = 1e-6)
        : limits_(std::move(limits)), period_(period_s), relative_(relative), oldest_(limits_.size()),
          before_(limits_.size()), last_(limits_.size()) {}

    void sample(const double *positions) {
        for (std::size_t i = 0; i < limits_.size(); ++i) {
            const double p = positions[i];
            const double largest =
                std::max({std::abs(p), std::abs(last_[i]), std::abs(before_[i]), std::abs(oldest_[i])});
            // A difference of order n adds 2^n roundings of the largest value.
            const double ulp = std::nextafter(largest, 1e308) - largest;
            if (count_ >= 1) {
                const double v = (p - last_[i]) / period_;
                note(i, 'v', std::abs(v), limits_[i].velocity, 2.0 * ulp / period_);
            }
            if (count_ >= 2) {
                const double a = (p - 2.0 * last_[i] + before_[i]) / (period_ * period_);
                note(i, 'a', std::abs(a), limits_[i].acceleration, 4.0 * ulp / (period_ * period_));
            }
            if (count_ >= 3) {
                const double cube = period_ * period_ * period_;
                const double j = (p - 3.0 * (last_[i] - before_[i]) - oldest_[i]) / cube;
                note(i, 'j', std::abs(j), limits_[i].jerk, 8.0 * ulp / cube);
            }
            oldest_[i] = before_[i];
            before_[i] = last_[i];
            last_[i] = p;
        }
        ++count_;
    }

    /// Call it after a permitted jump (a new position taken from feedback).
    void restart() { count_ = 0; }

    bool isWithin() const { return report_.empty(); }
    const std::string &report() const { return report_; }
    /// Largest observed ratio of |v|, |a| or |j| to its limit.
    double worst_velocity() const { return worst_v_; }
    double worst_acceleration() const { return worst_a_; }
    double worst_jerk() const { return worst_j_; }

  private:
    void note(std::size_t i, char what, double value, double limit, double rounding) {
        double &worst = what == 'v' ? worst_v_ : what == 'a' ? worst_a_ : worst_j_;
        worst = std::max(worst, (value - rounding) / limit);
        const bool isOver = !(value <= limit * (1.0 + relative_) + rounding);
        if (isOver && report_.size() < 2000) {
            char text[160];
            std::snprintf(text, sizeof text, "sample %zu coordinate %zu: %c = %.9g, limit %.9g\n", count_, i,
                          what, value, limit);
            report_ += text;
        }
    }

    std::vector<AxisLimit> limits_;
    double period_, relative_;
    std::vector<double> oldest_, before_, last_;
    std::size_t count_ = 0;
    double worst_v_ = 0, worst_a_ = 0, worst_j_ = 0;
    std::string report_;
};

}  // namespace mw::testing
