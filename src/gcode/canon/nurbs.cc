// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/canon/nurbs.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace mw::gcode {
namespace {

constexpr double TINY = 1e-12;
constexpr int MOST_HALVINGS = 14;
constexpr int CHECKS = 8;  ///< number of points of a piece at which its distance from the curve is checked

struct Vec {
    double x = 0, y = 0;
};
Vec operator+(Vec a, Vec b) {
    return {a.x + b.x, a.y + b.y};
}
Vec operator-(Vec a, Vec b) {
    return {a.x - b.x, a.y - b.y};
}
Vec operator*(Vec a, double k) {
    return {a.x * k, a.y * k};
}
double dot(Vec a, Vec b) {
    return a.x * b.x + a.y * b.y;
}
double cross(Vec a, Vec b) {
    return a.x * b.y - a.y * b.x;
}
double norm(Vec a) {
    return std::hypot(a.x, a.y);
}

struct Homogeneous {
    double x, y, w;
};

/// Parameters run from 0 to the number of spans.
class Curve {
  public:
    explicit Curve(const NurbsFeed &nurbs) : nurbs_(nurbs), degree_(nurbs.order - 1) {
        const int count = static_cast<int>(nurbs.points.size());
        spans_ = count - degree_;
        for (int i = 0; i < count + nurbs.order; ++i) {
            knots_.push_back(std::clamp(i - degree_, 0, spans_));
        }
    }
    int spans() const { return spans_; }

    /// De Boor's scheme in homogeneous coordinates.
    Vec point(double u) const {
        const int span = std::min(static_cast<int>(u), spans_ - 1) + degree_;
        std::array<Homogeneous, MAX_NURBS_ORDER> d;
        for (int i = 0; i <= degree_; ++i) {
            const NurbsPoint &p = nurbs_.points[static_cast<std::size_t>(span - degree_ + i)];
            d[static_cast<std::size_t>(i)] = {p.first * p.weight, p.second * p.weight, p.weight};
        }
        for (int level = 1; level <= degree_; ++level) {
            for (int i = degree_; i >= level; --i) {
                const double low = knots_[static_cast<std::size_t>(span - degree_ + i)];
                const double high = knots_[static_cast<std::size_t>(span + 1 + i - level)];
                const double k = high > low ? (u - low) / (high - low) : 0.0;
                const Homogeneous &a = d[static_cast<std::size_t>(i - 1)];
                Homogeneous &b = d[static_cast<std::size_t>(i)];
                b = {a.x + (b.x - a.x) * k, a.y + (b.y - a.y) * k, a.w + (b.w - a.w) * k};
            }
        }
        const Homogeneous &end = d[static_cast<std::size_t>(degree_)];
        return {end.x / end.w, end.y / end.w};
    }

    /// The tangent within the span that begins at `span`; zero at a cusp.
    Vec tangent(double u, int span) const {
        constexpr double STEP = 1e-5;
        const double low = std::max<double>(u - STEP, span), high = std::min<double>(u + STEP, span + 1);
        Vec way = point(high) - point(low);
        if (low < u && high > u) {  // central difference
            const double length = norm(way);
            return length > TINY * STEP ? way * (1.0 / length) : Vec{};
        }
        // One-sided: the parabola through three points.
        const double side = low < u ? -STEP : STEP;
        way = (point(u + side) * 4.0 - point(u + 2 * side) - point(u) * 3.0) * (side > 0 ? 1.0 : -1.0);
        const double length = norm(way);
        return length > TINY ? way * (1.0 / length) : Vec{};
    }

  private:
    const NurbsFeed &nurbs_;
    int degree_;
    int spans_;
    std::vector<int> knots_;
};

/// An arc from `from` in direction `tangent` to `to`.
PlanePiece arc_between(Vec from, Vec tangent, Vec to) {
    const Vec way = to - from;
    const Vec normal{-tangent.y, tangent.x};
    const double bend = 2.0 * dot(normal, way), square = dot(way, way);
    PlanePiece piece{to.x, to.y, 0, 0, 0, std::sqrt(square)};
    // An arc whose height is below the rounding error is a line.
    if (std::fabs(bend) <= 1e-9 * std::max(std::sqrt(square), TINY) || square <= TINY * TINY) {
        return piece;
    }
    const double radius = square / bend;  // > 0: curves to the left
    const Vec centre = from + normal * radius;
    piece.first_centre = centre.x;
    piece.second_centre = centre.y;
    piece.rotation = radius > 0 ? 1 : -1;
    const Vec a = from - centre, b = to - centre;
    double angle = std::atan2(cross(a, b), dot(a, b)) * piece.rotation;
    angle += angle < 0 ? 2 * std::numbers::pi : 0.0;
    piece.length = std::fabs(radius) * angle;
    return piece;
}

/// Two tangent arcs; a line when there are no tangents.
std::array<PlanePiece, 2> biarc(Vec from, Vec from_tangent, Vec to, Vec to_tangent, bool &good) {
    const Vec way = to - from, sum = from_tangent + to_tangent;
    // Handles of equal length d: |chord - d (t0 + t1)| = 2 d.
    const double turn = 2.0 * (1.0 - dot(from_tangent, to_tangent)), along = dot(way, sum);
    double d = 0;
    if (turn > 1e-9) {
        d = (-along + std::sqrt(along * along + turn * dot(way, way))) / turn;
    } else if (dot(way, to_tangent) > TINY) {
        d = dot(way, way) / (4.0 * dot(way, to_tangent));
    }
    good = d > TINY && norm(from_tangent) > 0.5 && norm(to_tangent) > 0.5;
    const Vec a = from + from_tangent * d, b = to - to_tangent * d;
    const Vec middle = (a + b) * 0.5;
    const Vec tangent = b - a;
    const double length = norm(tangent);
    good = good && length > TINY;
    if (!good) {
        return {};
    }
    return {arc_between(from, from_tangent, middle), arc_between(middle, tangent * (1.0 / length), to)};
}

/// Distance of `p`, a point beside the piece that begins at `from`, from this piece.
double distance(Vec p, Vec from, const PlanePiece &piece) {
    const Vec to{piece.first_end, piece.second_end};
    if (piece.rotation != 0) {
        const Vec centre{piece.first_centre, piece.second_centre};
        return std::fabs(norm(p - centre) - norm(from - centre));
    }
    const Vec way = to - from;
    const double square = dot(way, way);
    const double k = square > 0 ? std::clamp(dot(p - from, way) / square, 0.0, 1.0) : 0.0;
    return norm(p - (from + way * k));
}

class Approximation {
  public:
    Approximation(const Curve &curve, double tolerance) : curve_(curve), tolerance_(tolerance) {}

    void add(int span, double low, double high, int depth) {
        const Vec from = curve_.point(low), to = curve_.point(high);
        bool good = false;
        const auto arcs = biarc(from, curve_.tangent(low, span), to, curve_.tangent(high, span), good);
        if (good && isNear(low, high, from, arcs)) {
            pieces.push_back(arcs[0]);
            pieces.push_back(arcs[1]);
        } else if (depth >= MOST_HALVINGS) {
            pieces.push_back({to.x, to.y, 0, 0, 0, norm(to - from)});
        } else {
            const double middle = (low + high) / 2;
            add(span, low, middle, depth + 1);
            add(span, middle, high, depth + 1);
        }
    }

    std::vector<PlanePiece> pieces;

  private:
    bool isNear(double low, double high, Vec from, const std::array<PlanePiece, 2> &arcs) const {
        const Vec joint{arcs[0].first_end, arcs[0].second_end};
        double length = 0;
        Vec last = from;
        for (int i = 1; i <= CHECKS; ++i) {
            const Vec p = curve_.point(low + (high - low) * i / CHECKS);
            const double off = std::min(distance(p, from, arcs[0]), distance(p, joint, arcs[1]));
            if (off > tolerance_) {
                return false;
            }
            length += norm(p - last);
            last = p;
        }
        // Arcs in the opposite direction have nearly the same distances, but a different length.
        return arcs[0].length + arcs[1].length <= 1.2 * length + tolerance_;
    }

    const Curve &curve_;
    double tolerance_;
};

}  // namespace

std::vector<PlanePiece> approximate(const NurbsFeed &nurbs, double tolerance) {
    const Curve curve(nurbs);
    Approximation approximation(curve, tolerance);
    for (int span = 0; span < curve.spans(); ++span) {
        // Starts with two halves, so that a symmetric S does not become a line.
        approximation.add(span, span, span + 0.5, 1);
        approximation.add(span, span + 0.5, span + 1.0, 1);
    }
    return approximation.pieces;
}

}  // namespace mw::gcode
