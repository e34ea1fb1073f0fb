// SPDX-License-Identifier: GPL-2.0-or-later
// Random pockets milled in layers under cutter compensation, judged by a height map of the stock.
#pragma once

#include <string>
#include <vector>

#include "gcode/interpreter/test/comp_contours.hh"
#include "gcode/interpreter/test/comp_judge.hh"
#include "tests/support/stock/mill_stock.hh"

namespace mw::gcode::test {

/// The wall runs counterclockwise around the origin; the tool is inside.
struct Pocket {
    FlatPath wall;
    double radius = 1, layer = 1, helix = 1;
    int layers = 1;
    bool clockwise = false;  ///< cut clockwise, with the tool on its right

    double floor() const { return -layer * layers; }
};

class PocketMaker {
  public:
    explicit PocketMaker(unsigned seed) : dice_(seed) {}

    Pocket make() {
        constexpr int TRIES = 200;
        for (int i = 0; i < TRIES; ++i) {
            Pocket pocket = candidate();
            if (isFair(pocket)) {
                return pocket;
            }
        }
        return {};
    }

  private:
    Pocket candidate() {
        Pocket out;
        out.radius = dice_.between(0.8, 2.5);
        out.helix = 0.8 * out.radius;
        out.layer = dice_.between(0.3, 2.0);
        out.layers = 1 + dice_.up_to(2);
        out.clockwise = dice_.chance(0.4);
        const int corners = 4 + dice_.up_to(4);
        std::vector<FlatPoint> places;
        for (int i = 0; i < corners; ++i) {
            const double angle = 2.0 * PI * (i + dice_.between(-0.25, 0.25)) / corners;
            const double far = dice_.between(11.0, 20.0);
            places.push_back({far * std::cos(angle), far * std::sin(angle)});
        }
        // The first side begins in its middle, where the tool enters and leaves.
        const FlatPoint middle{(places[0].x + places[1].x) / 2.0, (places[0].y + places[1].y) / 2.0};
        out.wall.push_back(line(middle, places[1]));
        for (int i = 1; i < corners; ++i) {
            const FlatPoint from = places[static_cast<std::size_t>(i)];
            const FlatPoint to = places[static_cast<std::size_t>((i + 1) % corners)];
            out.wall.push_back(dice_.chance(0.4) ? bulge(from, to) : line(from, to));
        }
        out.wall.push_back(line(places[0], middle));
        return out;
    }
    static FlatPiece line(FlatPoint from, FlatPoint to) {
        FlatPiece piece;
        piece.start = from;
        piece.end = to;
        return piece;
    }
    FlatPiece bulge(FlatPoint from, FlatPoint to) {
        FlatPiece piece = line(from, to);
        const double half = flat_distance(from, to) / 2.0, sweep = dice_.sign() * dice_.between(0.2, 1.6);
        const double far = half / std::tan(sweep / 2.0);
        const double heading = piece.heading(0) + PI / 2.0;
        piece.isArc = true;
        piece.sweep_rad = sweep;
        piece.centre = {(from.x + to.x) / 2.0 + far * std::cos(heading),
                        (from.y + to.y) / 2.0 + far * std::sin(heading)};
        return piece;
    }
    /// True if the tool beside each side touches only the neighbours, beginning at the corner, and fits
    /// beside the middle.
    static bool isFair(const Pocket &pocket) {
        const double r = pocket.radius;
        const std::size_t count = pocket.wall.size();
        if (pocket.wall.front().length() < 5.0 * r || pocket.wall.back().length() < 5.0 * r ||
            testing::path_distance(pocket.wall, {0, 0}) < 4.0 * r + pocket.helix) {
            return false;
        }
        for (std::size_t k = 0; k < count; ++k) {
            const FlatPiece &piece = pocket.wall[k], &next = pocket.wall[(k + 1) % count];
            if (piece.isArc && piece.sweep_rad > 0 && piece.radius() < 1.1 * r) {
                return false;
            }
            const bool split = k + 1 == count;  // the two halves of the first side
            const Junction met = split ? Junction{} : junction(piece, next, r, 0.0045, 2e-4);
            if (met.crossing || met.before.share > 0.45 || met.behind.share > 0.45) {
                return false;
            }
            for (std::size_t m = 0; m < count; ++m) {
                const bool is_near = m == k || m == (k + 1) % count || (m + 1) % count == k;
                for (int i = 0; !is_near && i <= 60; ++i) {
                    if (pocket.wall[m].distance_to(piece.beside(i / 60.0, r)) < 1.02 * r) {
                        return false;
                    }
                }
            }
        }
        return true;
    }

    Dice dice_;
};

inline std::string program_of(const Pocket &pocket) {
    const auto place = [](FlatPoint p) { return fmt::format("X{:.6f} Y{:.6f}", p.x, p.y); };
    const double lead = 1.5 * pocket.radius;
    FlatPath wall = pocket.wall;
    if (pocket.clockwise) {
        std::reverse(wall.begin(), wall.end());
        for (FlatPiece &piece : wall) {
            std::swap(piece.start, piece.end);
            piece.sweep_rad = -piece.sweep_rad;
        }
    }
    const double side = pocket.clockwise ? -1.0 : 1.0, heading = wall.front().heading(0);
    const FlatPoint touch = wall.front().start, centre = wall.front().beside(0, side * lead);
    const FlatPoint along{lead * std::cos(heading), lead * std::sin(heading)};
    const int arc = pocket.clockwise ? 2 : 3, comp = pocket.clockwise ? 42 : 41;
    std::string text = "G21 G17 G90 G94 F300\nG0 Z5\n";
    for (int i = 1; i <= pocket.layers; ++i) {
        const double z = -pocket.layer * i;
        text += fmt::format("G0 X{:.6f} Y0\nG0 Z{:.6f}\n", pocket.helix, z + pocket.layer + 0.5);
        text += fmt::format("G1 Z{:.6f}\nG3 X{:.6f} Y0 I{:.6f} Z{:.6f}\nG3 I{:.6f}\n", z + pocket.layer,
                            pocket.helix, -pocket.helix, z, -pocket.helix);
        text += fmt::format("G{}.1 D{:.6f}\nG1 {}\n", comp, 2.0 * pocket.radius,
                            place({centre.x - along.x, centre.y - along.y}));
        text += fmt::format("G{} {} I{:.6f} J{:.6f}\n", arc, place(touch), along.x, along.y);
        for (const FlatPiece &piece : wall) {
            text += piece.isArc ? fmt::format("G{} {} I{:.6f} J{:.6f}\n", piece.sweep_rad > 0 ? 3 : 2,
                                              place(piece.end), piece.centre.x - piece.start.x,
                                              piece.centre.y - piece.start.y)
                                : fmt::format("G1 {}\n", place(piece.end));
        }
        text += fmt::format("G{} {} I{:.6f} J{:.6f}\n", arc, place({centre.x + along.x, centre.y + along.y}),
                            centre.x - touch.x, centre.y - touch.y);
        text += "G40\nG1 X0 Y0\nG0 Z5\n";
    }
    return text;
}

/// Cuts the stock move by move; stores the first fault.
class StockRecorder : public Recorder {
  public:
    StockRecorder(const Pocket &pocket, testing::MillStock &stock) : pocket_(pocket), stock_(stock) {}

    std::string fault;

    void begin_block(const BlockRef &block) override { line_ = block.line; }
    void line(const LineMove &move) override {
        go({move.end[0], move.end[1], move.end[2]}, move.settings.isRapid);
    }
    void arc(const ArcMove &move) override {
        const double radius = std::hypot(at_.x - move.centre[0], at_.y - move.centre[1]);
        const int pieces = 2 + static_cast<int>(std::fabs(move.angle_rad) * radius / 0.05);
        const testing::StockPoint from = at_;
        for (int i = 1; i <= pieces; ++i) {
            const double share = static_cast<double>(i) / pieces, a = move.angle_rad * share;
            const double dx = from.x - move.centre[0], dy = from.y - move.centre[1];
            go({move.centre[0] + dx * std::cos(a) - dy * std::sin(a),
                move.centre[1] + dx * std::sin(a) + dy * std::cos(a),
                from.z + (move.end[2] - from.z) * share},
               false);
        }
        at_ = {move.end[0], move.end[1], move.end[2]};
    }

  private:
    void go(testing::StockPoint to, bool rapid) {
        const testing::MillStock::Cut cut = stock_.cut(at_, to, pocket_.radius);
        constexpr double ROUNDING = 2e-6;
        if (fault.empty() && rapid && cut.deepest > ROUNDING) {
            fault = fmt::format("line {}: rapid {:.4f} deep in the stock", line_, cut.deepest);
        } else if (fault.empty() && cut.deepest > pocket_.layer + ROUNDING) {
            fault =
                fmt::format("line {}: layer of {:.4f}, {:.4f} allowed", line_, cut.deepest, pocket_.layer);
        }
        at_ = to;
    }
    const Pocket &pocket_;
    testing::MillStock &stock_;
    testing::StockPoint at_{0, 0, 50};
    int line_ = 0;
};

/// True if the wall surrounds the point.
inline bool isInside(const FlatPath &wall, FlatPoint p) {
    double turned = 0;
    for (const FlatPiece &piece : wall) {
        const int samples = piece.isArc ? 24 : 1;
        for (int i = 0; i < samples; ++i) {
            const FlatPoint a = piece.at(static_cast<double>(i) / samples), b = piece.at((i + 1.0) / samples);
            const double ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
            turned += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
        }
    }
    return std::fabs(turned) > PI;
}

inline std::string weigh_stock(const Pocket &pocket, const testing::MillStock &stock) {
    const double near = 1.5 * stock.cell();
    for (int row = 0; row < stock.rows(); ++row) {
        for (int column = 0; column < stock.columns(); ++column) {
            const testing::StockPoint p = stock.centre(column, row);
            if (p.z < pocket.floor() - 1e-5) {
                return fmt::format("too deep at {:.3f} {:.3f}: {:.4f}", p.x, p.y, p.z);
            }
            const bool is_cut = p.z < stock.top() - 1e-9;
            if (is_cut && !isInside(pocket.wall, {p.x, p.y}) &&
                testing::path_distance(pocket.wall, {p.x, p.y}) > 0.1 * stock.cell()) {
                return fmt::format("gouge at {:.3f} {:.3f}", p.x, p.y);
            }
        }
    }
    for (const FlatPiece &piece : pocket.wall) {
        for (int i = 0; i <= 200; ++i) {
            const FlatPoint tool = piece.beside(i / 200.0, pocket.radius);
            const FlatPoint beside = piece.beside(i / 200.0, near);
            const bool reached = testing::path_distance(pocket.wall, tool) >= pocket.radius - 1e-6;
            if (reached && stock.height_at(beside.x, beside.y) > pocket.floor() + 1e-5) {
                return fmt::format("left standing at {:.3f} {:.3f}", beside.x, beside.y);
            }
        }
    }
    return {};
}

inline CompVerdict judge_pocket(const Pocket &pocket, const std::string &program) {
    CompVerdict out;
    out.corners = pocket.wall.size() * static_cast<std::size_t>(pocket.layers);
    if (pocket.wall.empty()) {
        out.fault = "no pocket made";
        return out;
    }
    testing::MillStock stock({-30, -30, pocket.floor() - 5}, {30, 30, 0}, 0.25);
    StockRecorder recorder(pocket, stock);
    MachineFrame frame(recorder, LengthUnits::MM);
    Mill mill;
    Interpreter interpreter(frame, mill, mill, mill, {});
    if (run_text(interpreter, program) != Step::PROGRAM_END) {
        out.fault = interpreter.error().str();
        return out;
    }
    out.fault = recorder.fault.empty() ? weigh_stock(pocket, stock) : recorder.fault;
    return out;
}

inline CompVerdict judge_pocket(const Pocket &pocket) {
    return judge_pocket(pocket, program_of(pocket));
}

}  // namespace mw::gcode::test
