// SPDX-License-Identifier: GPL-2.0-or-later
// A block of material as a height map, cut by a flat-ended tool parallel to Z.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace mw::testing {

struct StockPoint {
    double x = 0, y = 0, z = 0;
};

class MillStock {
  public:
    MillStock(StockPoint low, StockPoint high, double cell)
        : low_(low), cell_(cell), columns_(static_cast<int>(std::ceil((high.x - low.x) / cell))),
          rows_(static_cast<int>(std::ceil((high.y - low.y) / cell))), top_(high.z),
          heights_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), high.z) {}

    /// Contacts of a move [machine units].
    struct Cut {
        double deepest = 0;  ///< material above the tool's end, at once
        StockPoint place;
    };

    /// Moves the tool in a straight line and removes the material that it meets.
    Cut cut(StockPoint from, StockPoint to, double radius) {
        const double way = std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
        const int steps = std::max(1, static_cast<int>(std::ceil(way / (0.5 * cell_))));
        Cut out;
        for (int i = 0; i <= steps; ++i) {
            const double share = static_cast<double>(i) / steps;
            stamp({from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share,
                   from.z + (to.z - from.z) * share},
                  radius, out);
        }
        return out;
    }
    double top() const { return top_; }
    double cell() const { return cell_; }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    double height(int column, int row) const { return heights_[index(column, row)]; }
    StockPoint centre(int column, int row) const {
        return {low_.x + (column + 0.5) * cell_, low_.y + (row + 0.5) * cell_, height(column, row)};
    }
    /// Height of the cell at the point; the top outside the block.
    double height_at(double x, double y) const {
        const int column = static_cast<int>(std::floor((x - low_.x) / cell_));
        const int row = static_cast<int>(std::floor((y - low_.y) / cell_));
        const bool isInside = column >= 0 && row >= 0 && column < columns_ && row < rows_;
        return isInside ? height(column, row) : top_;
    }

  private:
    std::size_t index(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(column);
    }
    /// Only cells whose centre is under the tool are cut.
    void stamp(StockPoint tool, double radius, Cut &out) {
        const int first = static_cast<int>(std::floor((tool.y - radius - low_.y) / cell_));
        const int last = static_cast<int>(std::ceil((tool.y + radius - low_.y) / cell_));
        for (int row = std::max(0, first); row < std::min(rows_, last); ++row) {
            const double dy = low_.y + (row + 0.5) * cell_ - tool.y;
            const double square = radius * radius - dy * dy;
            if (square <= 0.0) {
                continue;
            }
            const double half = std::sqrt(square);
            const int left = static_cast<int>(std::ceil((tool.x - half - low_.x) / cell_ - 0.5));
            const int right = static_cast<int>(std::floor((tool.x + half - low_.x) / cell_ - 0.5));
            for (int column = std::max(0, left); column <= std::min(columns_ - 1, right); ++column) {
                double &height = heights_[index(column, row)];
                if (height - tool.z > out.deepest) {
                    out.deepest = height - tool.z;
                    out.place = tool;
                }
                height = std::min(height, tool.z);
            }
        }
    }

    StockPoint low_;
    double cell_;
    int columns_, rows_;
    double top_;
    std::vector<double> heights_;
};

}  // namespace mw::testing
