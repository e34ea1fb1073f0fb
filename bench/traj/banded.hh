// SPDX-License-Identifier: GPL-2.0-or-later
// Symmetric positive definite equations with a band of non-zeros about the diagonal.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace mw::bench {

class Banded {
  public:
    void reset(std::size_t size, std::size_t band) {
        size_ = size;
        band_ = band;
        rows_.assign(size * (band + 1), 0.0);
    }
    /// Element (i, i - below) of the lower half.
    double &at(std::size_t i, std::size_t below) { return rows_[i * (band_ + 1) + below]; }

    /// Replaces the matrix by its Cholesky factors. A diagonal element that is lost to rounding becomes
    /// `least`.
    void factor(double least) {
        for (std::size_t i = 0; i < size_; ++i) {
            const std::size_t reach = std::min(i, band_);
            for (std::size_t d = reach; d > 0; --d) {
                const std::size_t j = i - d;
                double x = at(i, d);
                const std::size_t shared = std::min(reach - d, std::min(j, band_));
                const double *mine = &rows_[i * (band_ + 1) + d];
                const double *other = &rows_[j * (band_ + 1)];
                for (std::size_t e = 1; e <= shared; ++e) {
                    x -= mine[e] * other[e];
                }
                at(i, d) = x / other[0];
            }
            double x = at(i, 0);
            for (std::size_t d = 1; d <= reach; ++d) {
                x -= at(i, d) * at(i, d);
            }
            at(i, 0) = std::sqrt(std::max(x, least));
        }
    }

    void solve(std::vector<double> &x) {
        for (std::size_t i = 0; i < size_; ++i) {
            double y = x[i];
            for (std::size_t d = 1; d <= std::min(i, band_); ++d) {
                y -= at(i, d) * x[i - d];
            }
            x[i] = y / at(i, 0);
        }
        for (std::size_t i = size_; i-- > 0;) {
            x[i] /= at(i, 0);
            for (std::size_t d = 1; d <= std::min(i, band_); ++d) {
                x[i - d] -= at(i, d) * x[i];
            }
        }
    }

  private:
    std::size_t size_ = 0, band_ = 0;
    std::vector<double> rows_;
};

}  // namespace mw::bench
