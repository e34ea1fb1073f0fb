// SPDX-License-Identifier: GPL-2.0-or-later
#include "tests/support/stock/lathe_stock.hh"

#include <fmt/format.h>

namespace mw::testing {
namespace {

constexpr double MIDDLE = 0.4637;     ///< position inside a column that programs do not name
constexpr double FACE = 0.001;        ///< contact with the front face is in air [mm]
constexpr double CHORD_ERROR = 2e-5;  ///< of arcs as chords [mm]

std::string at_text(Place p) {
    return fmt::format("at u {:.4f} h {:.4f}", p.u, p.h);
}

}  // namespace

LatheStock::LatheStock(const Contour &contour, double surface, double behind)
    : contour_(contour), surface_(surface) {
    const double length = contour.last().u + behind - contour.first().u;
    columns_.assign(static_cast<std::size_t>(std::ceil(length / COLUMN)), surface);
}

double LatheStock::surface_at(double u) const {
    const double index = std::floor((u - contour_.first().u) / COLUMN);
    const bool isBeside = index < 0.0 || index >= static_cast<double>(columns_.size());
    return isBeside ? (index < 0.0 ? -1e9 : surface_) : columns_[static_cast<std::size_t>(index)];
}

/// A tool that touches a face is between two columns.
double LatheStock::lowest_near(double u) const {
    double lowest = surface_at(u);
    for (const double aside : {-NEAR, -COLUMN, COLUMN, NEAR}) {
        lowest = std::fmin(lowest, surface_at(u + aside));
    }
    return lowest;
}

/// Whether all material up to `top` is the allowance of earlier cycles on the contour or on the face at its
/// end.
bool LatheStock::isSkin(Place top, const CutRules &rules) const {
    const double reach = rules.skin + rules.tolerance + NEAR;
    const bool isAtEnd = rules.skin > 0.0 && std::fabs(top.u - contour_.last().u) <= reach;
    return isAtEnd || contour_.distance(top) <= reach || top.h <= contour_.height(top.u);
}

std::string LatheStock::cut_to(Place from, Place to, bool isRapid, const CutRules &rules) {
    const Place left = from.u < to.u ? from : to, right = from.u < to.u ? to : from;
    const double first_u = contour_.first().u;
    if (isRapid) {
        const int steps = 1 + static_cast<int>(span(from, to) / COLUMN);
        for (int i = 0; i <= steps; ++i) {
            const Place p{from.u + (to.u - from.u) * i / steps, from.h + (to.h - from.h) * i / steps};
            if (p.h < lowest_near(p.u) - DEPTH_SPARE) {
                return fmt::format("rapid in stock {}, {:.3f} deep", at_text(p), lowest_near(p.u) - p.h);
            }
        }
        return {};
    }
    const double plunged = lowest_near(to.u) - to.h;
    if (right.u - left.u < COLUMN && plunged > rules.step + DEPTH_SPARE &&
        !isSkin({to.u, lowest_near(to.u)}, rules)) {
        return fmt::format("plunge {:.3f} deep {}", plunged, at_text(to));
    }
    const auto index = [&](double u) {
        return static_cast<long>(std::ceil((u - first_u) / COLUMN - MIDDLE));
    };
    const long end = std::min(index(right.u), static_cast<long>(columns_.size()));
    // On a slope the tolerance of the contour is a correspondingly larger part of the height.
    const double slope = right.u > left.u ? std::fabs(right.h - left.h) / (right.u - left.u) : 0.0;
    const double deepest = rules.step + DEPTH_SPARE + rules.tolerance * slope;
    for (long i = std::max(0L, index(left.u)); i < end; ++i) {
        const double u = first_u + (static_cast<double>(i) + MIDDLE) * COLUMN;
        const double h = left.h + (right.h - left.h) * (u - left.u) / (right.u - left.u);
        double &column = columns_[static_cast<std::size_t>(i)];
        if (column - h > deepest && !isSkin({u, column}, rules)) {
            return fmt::format("layer {:.3f} deep {}", column - h, at_text({u, h}));
        }
        column = std::fmin(column, h);
    }
    return {};
}

std::string LatheStock::cut(const StockMove &move, const CutRules &rules) {
    const Stroke &path = move.path;
    const int checks = 1 + static_cast<int>(path.length() / 0.05);
    for (int i = 0; i <= checks; ++i) {
        const Place p = path.at(static_cast<double>(i) / checks);
        const bool isInAir = p.u < contour_.first().u + FACE;
        if (!isInAir && contour_.clearance(p) < rules.allowance - rules.tolerance) {
            return fmt::format("gouge {:.4f} {}", rules.allowance - contour_.clearance(p), at_text(p));
        }
    }
    const double turn =
        path.isArc ? 2.0 * std::acos(1.0 - CHORD_ERROR / std::fmax(path.radius(), 0.001)) : 1.0;
    const int chords = path.isArc ? 1 + static_cast<int>(path.turned(path.to) / turn) : 1;
    for (int i = 0; i < chords; ++i) {
        std::string fault = cut_to(path.at(static_cast<double>(i) / chords),
                                   path.at(static_cast<double>(i + 1) / chords), move.isRapid, rules);
        if (!fault.empty()) {
            return fault;
        }
    }
    return {};
}

std::string LatheStock::unfinished(double allowance, bool isPocketLeft, double end_allowance) const {
    const double last_u = contour_.last().u - end_allowance - COLUMN;
    double rim = -1e9;
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        const Place p{contour_.first().u + (static_cast<double>(i) + MIDDLE) * COLUMN, columns_[i]};
        if (p.u > last_u) {
            break;
        }
        rim = std::fmax(rim, contour_.highest(p.u));
        const bool isLeft = isPocketLeft && p.h <= rim + allowance + 2.0 * DEPTH_SPARE;
        // The walls beside a column are as close as its middle.
        if (!isLeft && contour_.clearance(p) > allowance + NEAR) {
            return fmt::format("{:.3f} left {}", contour_.clearance(p), at_text(p));
        }
    }
    return {};
}

}  // namespace mw::testing
