// SPDX-License-Identifier: GPL-2.0-or-later
// Judges a milled contour by the circle that the tool sweeps in a plane. Independent of compensation: uses
// only distances between points, straight lines and arcs.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace mw::testing {

struct FlatPoint {
    double x = 0, y = 0;
};

inline double flat_distance(FlatPoint a, FlatPoint b) {
    return std::hypot(b.x - a.x, b.y - a.y);
}

/// A straight line or an arc from `start` to `end`.
struct FlatPiece {
    FlatPoint start, end;
    bool isArc = false;
    FlatPoint centre;
    double sweep_rad = 0;  ///< signed, counterclockwise positive

    double radius() const { return flat_distance(centre, end); }
    double length() const { return isArc ? std::fabs(sweep_rad) * radius() : flat_distance(start, end); }
    FlatPoint at(double share) const {
        if (!isArc) {
            return {start.x + (end.x - start.x) * share, start.y + (end.y - start.y) * share};
        }
        const double c = std::cos(sweep_rad * share), s = std::sin(sweep_rad * share);
        const FlatPoint arm{start.x - centre.x, start.y - centre.y};
        return {centre.x + arm.x * c - arm.y * s, centre.y + arm.x * s + arm.y * c};
    }
    /// The direction of travel [rad].
    double heading(double share) const {
        if (!isArc) {
            return std::atan2(end.y - start.y, end.x - start.x);
        }
        const FlatPoint p = at(share);
        return std::atan2(p.y - centre.y, p.x - centre.x) + std::copysign(std::numbers::pi / 2.0, sweep_rad);
    }
    /// `reach` to the left (negative: to the right) of the piece.
    FlatPoint beside(double share, double reach) const {
        const double across = heading(share) + std::numbers::pi / 2.0;
        const FlatPoint p = at(share);
        return {p.x + reach * std::cos(across), p.y + reach * std::sin(across)};
    }
    double distance_to(FlatPoint p) const {
        const double ends = std::min(flat_distance(p, start), flat_distance(p, end));
        if (!isArc) {
            const double dx = end.x - start.x, dy = end.y - start.y, square = dx * dx + dy * dy;
            const double share = square > 0.0 ? ((p.x - start.x) * dx + (p.y - start.y) * dy) / square : 0.0;
            return share > 0.0 && share < 1.0 ? flat_distance(p, at(share)) : ends;
        }
        const FlatPoint a{start.x - centre.x, start.y - centre.y}, b{p.x - centre.x, p.y - centre.y};
        double turned = std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
        turned = sweep_rad > 0.0 ? turned : -turned;
        turned = turned < 0.0 ? turned + 2.0 * std::numbers::pi : turned;
        const bool isBeside = turned <= std::fabs(sweep_rad);
        return isBeside ? std::min(ends, std::fabs(std::hypot(b.x, b.y) - radius())) : ends;
    }
};

using FlatPath = std::vector<FlatPiece>;

inline double path_distance(const FlatPath &path, FlatPoint p) {
    double least = 1e300;
    for (const FlatPiece &piece : path) {
        least = std::min(least, piece.distance_to(p));
    }
    return least;
}

inline int samples_of(const FlatPiece &piece, double step) {
    return std::clamp(static_cast<int>(std::ceil(piece.length() / step)), 4, 20000);
}

/// Largest amount by which the tool comes closer to the contour than its radius, and its position.
struct Gouge {
    double depth = 0;
    FlatPoint place;
};

inline Gouge worst_gouge(const FlatPath &tool_path, const FlatPath &contour, double radius) {
    Gouge worst;
    for (const FlatPiece &piece : tool_path) {
        const int samples = samples_of(piece, 0.02 * radius);
        for (int i = 0; i <= samples; ++i) {
            const FlatPoint p = piece.at(static_cast<double>(i) / samples);
            const double depth = radius - path_distance(contour, p);
            worst = depth > worst.depth ? Gouge{depth, p} : worst;
        }
    }
    return worst;
}

/// Material that the tool has left although it could have cut it.
struct Leftover {
    double height = 0;               ///< on the contour
    FlatPoint place;                 ///< of the contour
    double wanted = 0, reached = 0;  ///< lengths of the contour
};

/// The part of a piece that is to be cut.
struct Stretch {
    double from = 0, to = 1;  ///< fractions of the piece
};

/// `stretches` defines the part of each piece that the tool must cut; `side` is +1 for a tool to the left of
/// the contour, else -1. Points where the tool would be closer to a wall than its radius less `free` need not
/// be cut.
inline Leftover worst_leftover(const FlatPath &tool_path, const FlatPath &contour,
                               const std::vector<Stretch> &stretches, const FlatPath &walls, double radius,
                               int side, double tolerance, double free) {
    Leftover worst;
    for (std::size_t k = 0; k < contour.size(); ++k) {
        const FlatPiece &piece = contour[k];
        const int samples = samples_of(piece, 0.05 * radius);
        for (int i = 0; i <= samples; ++i) {
            const double share = static_cast<double>(i) / samples;
            const FlatPoint due = piece.beside(share, side * radius);
            const bool isDue = share >= stretches[k].from && share <= stretches[k].to;
            if (!isDue || path_distance(walls, due) < radius - free) {
                continue;
            }
            // The tool does not cut from the other side.
            const bool isBeside = path_distance(tool_path, due) < 0.3 * radius;
            const double left = path_distance(tool_path, piece.at(share)) - radius;
            const double height = isBeside ? left : radius;
            worst.wanted += piece.length() / samples;
            worst.reached += height <= tolerance ? piece.length() / samples : 0.0;
            if (height > worst.height) {
                worst.height = height;
                worst.place = piece.at(share);
            }
        }
    }
    return worst;
}

}  // namespace mw::testing
