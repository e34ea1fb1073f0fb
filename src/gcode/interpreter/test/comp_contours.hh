// SPDX-License-Identifier: GPL-2.0-or-later
// Random contours for cutter compensation: lines and arcs at any angle, with a tool that fits most of them,
// and a program for each contour.
#pragma once

#include <array>
#include <optional>
#include <random>
#include <string>

#include <fmt/format.h>

#include "tests/support/stock/mill_path.hh"

namespace mw::gcode::test {

using testing::flat_distance;
using testing::FlatPath;
using testing::FlatPiece;
using testing::FlatPoint;

constexpr double PI = std::numbers::pi;

class Dice {
  public:
    explicit Dice(unsigned seed) : engine_(seed) {}
    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
    }
    double log_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
    bool chance(double share) { return between(0, 1) < share; }
    int sign() { return chance(0.5) ? 1 : -1; }
    int up_to(int most) { return static_cast<int>(between(0, most + 0.999999)); }

  private:
    std::mt19937 engine_;
};

/// The first piece of the path is the entry; the contour follows.
struct CompContour {
    int side = 1;  ///< +1: left
    double radius = 1;
    bool isInch = false, is_xz = false, tabled = false;
    int decimals = 9;
    FlatPiece entry;
    FlatPath pieces;
    std::array<double, 16> heights{};  ///< heights of the piece ends along the plane's normal
    FlatPoint exit;
    bool crossing = false;  ///< the contour reverses at a tip and loses more than permitted there
    bool tight = false;     ///< the tool can cut at most a seventh of one of the pieces

    double mm() const { return isInch ? 25.4 : 1.0; }
};

inline double corner_angle(const FlatPiece &a, const FlatPiece &b) {
    const double turn = b.heading(0) - a.heading(1);
    return std::atan2(std::sin(turn), std::cos(turn));
}

/// Range in which the tool beside `piece` would touch `other`, measured from their common corner.
struct Contact {
    double share = 0;    ///< fraction of the piece in the first range
    double deepest = 0;  ///< depth in the first range
    double apart = 0;    ///< depth in a second range
    FlatPoint free;      ///< end of the first range
};

/// A wedge between the two pieces that closes again within `tolerance` belongs to the first range.
inline Contact contact(const FlatPiece &piece, const FlatPiece &other, double reach, double tolerance,
                       bool from_end) {
    constexpr int SAMPLES = 240;
    constexpr double FREE = 1e-7;
    const auto tool = [&](double share) { return piece.beside(from_end ? 1.0 - share : share, reach); };
    const auto depth = [&](double share) { return std::fabs(reach) - other.distance_to(tool(share)); };
    const auto share_of = [](int i) {
        const double root = static_cast<double>(i) / SAMPLES;
        return root * root;
    };
    Contact out;
    const auto isClosed = [&](double share) {
        return other.distance_to(piece.at(from_end ? 1.0 - share : share)) < tolerance;
    };
    int i = 0;
    while (i < SAMPLES && isClosed(share_of(i)) && depth(share_of(i)) <= FREE) {
        ++i;
    }
    i = depth(share_of(i)) > FREE ? i : 0;
    for (; i <= SAMPLES && (i == 0 || depth(share_of(i)) > FREE); ++i) {
        out.deepest = std::max(out.deepest, depth(share_of(i)));
    }
    double touched = i > 1 ? share_of(i - 1) : 0.0, clear = i > 1 ? share_of(std::min(i, SAMPLES)) : 0.0;
    for (int k = 0; k < 50 && clear > touched; ++k) {
        const double middle = (touched + clear) / 2.0;
        (depth(middle) > FREE ? touched : clear) = middle;
    }
    out.share = i > SAMPLES ? 1.0 : clear;
    out.free = tool(out.share);
    for (; i <= SAMPLES; ++i) {
        out.apart = std::max(out.apart, depth(share_of(i)));
    }
    return out;
}

/// Junction of two pieces, by the points where the tool touches one while it cuts the other.
struct Junction {
    Contact before, behind;
    bool crossing = false;  ///< the ranges cannot be omitted, because they end at different points
};

/// `rounding`: distance between the ends of the ranges that rounded coordinates may cause.
inline Junction junction(const FlatPiece &before, const FlatPiece &behind, double reach, double tolerance,
                         double rounding) {
    Junction out{contact(before, behind, reach, tolerance, true),
                 contact(behind, before, reach, tolerance, false)};
    const double radius = std::fabs(reach);
    const bool has_second = std::max(out.before.apart, out.behind.apart) > tolerance;
    const bool touching = std::max(out.before.deepest, out.behind.deepest) > tolerance;
    const double gap = flat_distance(out.before.free, out.behind.free);
    out.crossing = has_second || (touching && gap > rounding);
    const double turn = corner_angle(before, behind);
    const bool is_reversal = std::fabs(turn) > PI - 0.31;
    if (!touching && (turn * reach < 0.0 || is_reversal)) {
        constexpr int SAMPLES = 60;
        for (int i = 0; i <= SAMPLES; ++i) {
            const double angle = before.heading(1) + std::copysign(PI / 2.0, reach) +
                                 std::copysign(turn, -reach) * i / SAMPLES;
            const FlatPoint around{before.end.x + radius * std::cos(angle),
                                   before.end.y + radius * std::sin(angle)};
            const double depth = radius - std::min(before.distance_to(around), behind.distance_to(around));
            out.crossing = out.crossing || depth > tolerance;
        }
    }
    return out;
}

/// Permitted loss of a contour that reverses.
inline double tip_tolerance(const CompContour &c) {
    constexpr double MM = 0.0045;
    return MM / c.mm();
}

inline double ends_apart(const CompContour &c) {
    return c.decimals == 4 ? 0.006 : 2e-4;
}

class ContourMaker {
  public:
    explicit ContourMaker(unsigned seed) : dice_(seed) {}

    CompContour make() {
        contour_ = {};
        contour_.side = dice_.sign();
        contour_.isInch = dice_.chance(0.15);
        contour_.is_xz = dice_.chance(0.15);
        contour_.tabled = dice_.chance(0.3);
        contour_.decimals = dice_.chance(0.25) ? 4 : 9;
        contour_.radius = round(dice_.log_between(0.2, 8.0) / contour_.mm());
        const FlatPoint origin{round(dice_.between(-20, 20)), round(dice_.between(-20, 20))};
        double heading = dice_.between(-PI, PI);
        make_entry(origin, heading);
        const int count = 2 + dice_.up_to(7);
        for (int i = 0; i < count; ++i) {
            if (!add_piece(i == 0 ? heading : 0)) {
                break;
            }
        }
        double height = 0;
        for (double &z : contour_.heights) {
            height += dice_.chance(0.2) ? dice_.between(-1, 1) : 0.0;
            z = height;
        }
        const FlatPiece &last = contour_.pieces.back();
        const FlatPoint way = last.beside(1.0, contour_.side * 3.0 * contour_.radius);
        contour_.exit = {way.x + 2.0 * contour_.radius * std::cos(last.heading(1)),
                         way.y + 2.0 * contour_.radius * std::sin(last.heading(1))};
        return contour_;
    }

  private:
    double round(double value) const {
        const double scale = std::pow(10.0, contour_.decimals);
        return std::round(value * scale) / scale;
    }
    FlatPoint round(FlatPoint p) const { return {round(p.x), round(p.y)}; }

    void make_entry(FlatPoint to, double heading) {
        const double r = contour_.radius;
        const double back = r * dice_.between(1.5, 5.0), beside = contour_.side * r * dice_.between(0.0, 1.0);
        contour_.entry.end = to;
        contour_.entry.start = round(FlatPoint{to.x - back * std::cos(heading) - beside * std::sin(heading),
                                               to.y - back * std::sin(heading) + beside * std::cos(heading)});
    }

    /// A random angle, most often near 0 and 180 degrees.
    double turn() {
        const double near = dice_.log_between(1e-7, 0.09);
        switch (dice_.up_to(9)) {
        case 0: return dice_.sign() * near;
        case 1:
        case 2: return dice_.sign() * (PI - near);
        case 3: return PI;
        case 4: return 0.0;
        case 5: return dice_.sign() * PI / 2.0;
        default: return dice_.between(-PI, PI);
        }
    }

    FlatPiece candidate(double heading) {
        const FlatPoint from = contour_.pieces.empty() ? contour_.entry.end : contour_.pieces.back().end;
        FlatPiece piece;
        piece.start = from;
        const double r = contour_.radius;
        if (dice_.chance(0.4)) {
            const double length = r * dice_.log_between(0.3, 40.0);
            piece.end =
                round(FlatPoint{from.x + length * std::cos(heading), from.y + length * std::sin(heading)});
            return piece;
        }
        const int rotation = dice_.sign();
        const bool inside = rotation == contour_.side;
        const double radius = r * (inside ? dice_.log_between(1.05, 40.0) : dice_.log_between(0.2, 40.0));
        const double across = heading + rotation * PI / 2.0;
        piece.isArc = true;
        piece.centre =
            round(FlatPoint{from.x + radius * std::cos(across), from.y + radius * std::sin(across)});
        if (dice_.chance(0.03)) {
            piece.end = from;
            piece.sweep_rad = rotation * 2.0 * PI;
            return piece;
        }
        piece.sweep_rad = rotation * dice_.log_between(0.02, 3.0);
        piece.end = round(piece.at(1.0));
        const FlatPoint a{from.x - piece.centre.x, from.y - piece.centre.y};
        const FlatPoint b{piece.end.x - piece.centre.x, piece.end.y - piece.centre.y};
        double sweep = std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
        sweep = sweep * rotation < 0.0 ? sweep + rotation * 2.0 * PI : sweep;
        piece.sweep_rad = sweep;
        return piece;
    }

    /// Path of the tool centre around the corner after `before`, if it is convex.
    FlatPoint around(const FlatPiece &before, const FlatPiece &behind, double share) const {
        const double turn = corner_angle(before, behind), reach = contour_.side * contour_.radius;
        const bool convex = turn * reach < 0.0 || std::fabs(turn) > PI - 0.31;
        const double angle = before.heading(1) + std::copysign(PI / 2.0, reach) +
                             (convex ? std::copysign(turn, -reach) * share : 0.0);
        return {before.end.x + contour_.radius * std::cos(angle),
                before.end.y + contour_.radius * std::sin(angle)};
    }

    /// True if the tool along `piece` touches only the previous piece, and the tool along other pieces does
    /// not touch `piece`.
    bool isApart(const FlatPiece &piece) const {
        constexpr int SAMPLES = 120;
        const double r = contour_.radius, reach = contour_.side * r;
        for (std::size_t k = 0; k < contour_.pieces.size(); ++k) {
            const bool is_last = k + 1 == contour_.pieces.size();
            const FlatPiece &behind = is_last ? piece : contour_.pieces[k + 1];
            for (int i = 0; i <= SAMPLES / 4; ++i) {
                const FlatPoint tool = around(contour_.pieces[k], behind, 4.0 * i / SAMPLES);
                for (std::size_t m = 0; is_last && m < k; ++m) {
                    if (contour_.pieces[m].distance_to(tool) < 1.02 * r) {
                        return false;
                    }
                }
                if (!is_last && piece.distance_to(tool) < 1.02 * r) {
                    return false;
                }
            }
        }
        for (std::size_t k = 0; k + 1 < contour_.pieces.size(); ++k) {
            const FlatPiece &other = contour_.pieces[k];
            for (int i = 0; i <= SAMPLES; ++i) {
                const double share = static_cast<double>(i) / SAMPLES;
                if (other.distance_to(piece.beside(share, reach)) < 1.02 * r ||
                    piece.distance_to(other.beside(share, reach)) < 1.02 * r) {
                    return false;
                }
            }
        }
        return true;
    }

    /// True if the piece is so long that rounding of its ends does not change its direction.
    bool isSound(const FlatPiece &piece) const {
        const double least = contour_.decimals == 4 ? 0.05 : 1e-4;
        return piece.length() > least &&
               (!piece.isArc || std::fabs(piece.sweep_rad) < 3.2 || piece.end.x == piece.start.x) &&
               (!piece.isArc || piece.radius() > least);
    }

    /// True if the neighbours of a corner touch the tool only in one range that begins at the corner.
    bool isFair(const FlatPiece &piece, bool &crossing, bool &tight) {
        const double reach = contour_.side * contour_.radius;
        const FlatPiece &before = contour_.pieces.empty() ? contour_.entry : contour_.pieces.back();
        const Junction met = junction(before, piece, reach, tip_tolerance(contour_), ends_apart(contour_));
        crossing = met.crossing;
        if (crossing && !dice_.chance(0.002)) {
            return false;
        }
        tight = met.before.share + taken_ >= 0.85 || met.behind.share > 0.85;
        if (tight && !dice_.chance(0.002)) {
            return false;
        }
        made_ = met.behind.share;
        return true;
    }

    bool add_piece(double first_heading) {
        constexpr int TRIES = 40;
        for (int i = 0; i < TRIES; ++i) {
            const bool first = contour_.pieces.empty();
            const double heading = first ? first_heading : contour_.pieces.back().heading(1) + turn();
            const FlatPiece piece = candidate(heading);
            bool crossing = false, tight = false;
            if (!isSound(piece) || !isApart(piece) || !isFair(piece, crossing, tight)) {
                continue;
            }
            taken_ = made_;
            contour_.crossing = contour_.crossing || crossing;
            contour_.tight = contour_.tight || tight;
            contour_.pieces.push_back(piece);
            return true;
        }
        return false;
    }

    Dice dice_;
    CompContour contour_;
    double taken_ = 0, made_ = 0;  ///< fraction of the last piece that its first corner uses
};

/// Line 1 of the contour is line `FIRST_LINE` of the program.
constexpr int FIRST_LINE = 6;

inline std::string program_of(const CompContour &c) {
    const char a = c.is_xz ? 'Z' : 'X', b = c.is_xz ? 'X' : 'Y', n = c.is_xz ? 'Y' : 'Z';
    const char i = c.is_xz ? 'K' : 'I', j = c.is_xz ? 'I' : 'J';
    const auto place = [&](FlatPoint p) {
        return fmt::format("{}{:.{}f} {}{:.{}f}", a, p.x, c.decimals, b, p.y, c.decimals);
    };
    std::string text = fmt::format("{} {} G90 G94 F100\n", c.isInch ? "G20" : "G21", c.is_xz ? "G18" : "G17");
    text += fmt::format("G0 {}0\nG0 {}\n", n, place(c.entry.start));
    const int code = c.side > 0 ? 41 : 42;
    text += c.tabled ? fmt::format("G{} D7\n", code)
                     : fmt::format("G{}.1 D{:.{}f}\n", code, 2.0 * c.radius, c.decimals);
    text += fmt::format("G1 {}\n", place(c.entry.end));
    for (std::size_t k = 0; k < c.pieces.size(); ++k) {
        const FlatPiece &p = c.pieces[k];
        text += fmt::format("{} {} {}{:.4f}",
                            !p.isArc          ? "G1"
                            : p.sweep_rad > 0 ? "G3"
                                              : "G2",
                            place(p.end), n, c.heights[std::min<std::size_t>(k, 15)]);
        if (p.isArc) {
            text += fmt::format(" {}{:.{}f} {}{:.{}f}", i, p.centre.x - p.start.x, c.decimals, j,
                                p.centre.y - p.start.y, c.decimals);
        }
        text += '\n';
    }
    return text + fmt::format("G40\nG1 {}\n", place(c.exit));
}

}  // namespace mw::gcode::test
