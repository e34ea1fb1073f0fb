// SPDX-License-Identifier: GPL-2.0-or-later
// Cuts a random contour and judges it: no gouges, everything is cut that the tool can reach, and a rejection
// has a reason in the contour.
#pragma once

#include <string>
#include <vector>

#include "gcode/interpreter/test/comp_contours.hh"
#include "gcode/interpreter/test/recorder.hh"

namespace mw::gcode::test {

/// Moves and their lines, in the plane of the contour.
class PlaneRecorder : public Recorder {
  public:
    explicit PlaneRecorder(const CompContour &contour) : contour_(contour) {}

    FlatPath path;
    std::vector<int> line_of;
    int now = 0;

    void begin_block(const BlockRef &block) override { now = block.line; }
    void line(const LineMove &move) override {
        FlatPiece piece;
        piece.end = flat(move.end);
        add(piece);
    }
    void arc(const ArcMove &move) override {
        FlatPiece piece;
        piece.isArc = true;
        piece.end = flat(move.end);
        piece.centre = flat(move.centre);
        piece.sweep_rad = move.angle_rad;
        add(piece);
    }

  private:
    FlatPoint flat(const Pose &p) const {
        const double mm = contour_.mm();
        return contour_.is_xz ? FlatPoint{p[geometry::AXIS_Z] / mm, p[geometry::AXIS_X] / mm}
                              : FlatPoint{p[geometry::AXIS_X] / mm, p[geometry::AXIS_Y] / mm};
    }
    void add(FlatPiece piece) {
        piece.start = at_;
        at_ = piece.end;
        path.push_back(piece);
        line_of.push_back(now);
    }
    const CompContour &contour_;
    FlatPoint at_;
};

struct CompVerdict {
    std::size_t corners = 0;
    std::string fault;    ///< empty: no fault
    std::string refused;  ///< the reason when the program was rejected
    double wanted = 0, reached = 0;
};

inline Step run_text(Interpreter &interpreter, const std::string &text) {
    if (!interpreter.begin()) {
        return Step::FAILED;
    }
    interpreter.open_text("contour.ngc", text + "M2\n");
    Step step = Step::OK;
    while (step == Step::OK) {
        step = interpreter.step();
    }
    return step;
}

/// Distance by which the tool may be nearer to the contour than its radius: a nearly straight corner, a
/// reversal at a tip, rounded coordinates [program units].
inline double allowed_gouge(const CompContour &c) {
    constexpr double STRAIGHT = 0.05 * 0.05 / 2.0, TIP_MM = 0.005;
    return 1.02 * STRAIGHT * c.radius + TIP_MM / c.mm() + (c.decimals == 4 ? 4e-4 : 1e-6);
}

inline void weigh(const CompContour &c, const PlaneRecorder &recorder, CompVerdict &out) {
    FlatPath cut;
    bool has_entry = false;
    for (std::size_t i = 0; i < recorder.path.size(); ++i) {
        const int line = recorder.line_of[i];
        const bool is_contour = line >= FIRST_LINE && line < FIRST_LINE + static_cast<int>(c.pieces.size());
        has_entry = has_entry || line == FIRST_LINE - 1;
        if (is_contour) {
            cut.push_back(recorder.path[i]);
        }
    }
    if (cut.empty() || !has_entry) {
        out.fault = "nothing cut";
        return;
    }
    const testing::Gouge gouge = testing::worst_gouge(cut, c.pieces, c.radius);
    if (gouge.depth > allowed_gouge(c)) {
        out.fault = fmt::format("gouge {:.5f} at {:.4f} {:.4f}", gouge.depth, gouge.place.x, gouge.place.y);
        return;
    }
    if (c.crossing) {
        return;
    }
    FlatPath walls = c.pieces;
    walls.push_back(c.entry);
    std::vector<testing::Stretch> stretches(c.pieces.size());
    for (std::size_t k = 0; k < c.pieces.size(); ++k) {
        const FlatPiece &before = k == 0 ? c.entry : c.pieces[k - 1];
        const Junction met =
            junction(before, c.pieces[k], c.side * c.radius, tip_tolerance(c), ends_apart(c));
        stretches[k].from = met.behind.share;
        if (k > 0) {
            stretches[k - 1].to = 1.0 - met.before.share;
        }
    }
    const double near = 2.0 * allowed_gouge(c) + (c.decimals == 4 ? 0.01 : 1e-4 * c.radius);
    const testing::Leftover left = testing::worst_leftover(cut, c.pieces, stretches, walls, c.radius, c.side,
                                                           near, c.decimals == 4 ? 4e-4 : 1e-6);
    out.wanted = left.wanted;
    out.reached = left.reached;
    if (left.height > near) {
        out.fault =
            fmt::format("not cut at {:.4f} {:.4f}: {:.5f} left", left.place.x, left.place.y, left.height);
    }
}

/// Fraction of a piece that the tool can cut without touching the others.
inline double free_share(const FlatPiece &piece, const std::vector<FlatPiece> &others, double reach) {
    constexpr int SAMPLES = 4000;
    int count = 0;
    for (int i = 0; i <= SAMPLES; ++i) {
        const FlatPoint tool = piece.beside(static_cast<double>(i) / SAMPLES, reach);
        count += testing::path_distance(others, tool) >= std::fabs(reach) ? 1 : 0;
    }
    return static_cast<double>(count) / SAMPLES;
}

/// Checks that the contour explains the rejection at `line`.
inline void explain(const CompContour &c, int line, const std::string &error, CompVerdict &out) {
    const int at = line - FIRST_LINE;
    const bool concave = error.find("in concave corner") != std::string::npos;
    if (!concave || at < 0 || at >= static_cast<int>(c.pieces.size())) {
        out.fault = "refused: " + error.substr(0, error.find('\n'));
        return;
    }
    const auto k = static_cast<std::size_t>(at);
    const double reach = c.side * c.radius;
    const FlatPiece &before = k == 0 ? c.entry : c.pieces[k - 1], &piece = c.pieces[k];
    std::vector<FlatPiece> around{piece};
    if (k > 0) {
        around.push_back(k == 1 ? c.entry : c.pieces[k - 2]);
    }
    constexpr double LITTLE = 1.0 / 7.0;
    const double last = free_share(before, around, reach), next = free_share(piece, {before}, reach);
    const Junction met = junction(before, piece, reach, tip_tolerance(c), ends_apart(c));
    if (last < LITTLE || next < LITTLE) {
        out.refused = "a move beside the corner of which the tool reaches a seventh at most";
    } else if (met.crossing) {
        out.refused = "a contour that leads back over itself";
    } else {
        out.fault = fmt::format("rejected without a reason: {:.4f} and {:.4f} of the moves are free; {}",
                                last, next, error.substr(0, error.find('\n')));
    }
}

inline CompVerdict judge_contour(const CompContour &contour, const std::string &program) {
    PlaneRecorder recorder(contour);
    MachineFrame frame(recorder, LengthUnits::MM);
    Mill mill;
    mill.tools.emplace_back();
    mill.tools[1].toolno = 7;
    mill.tools[1].diameter = 2.0 * contour.radius * contour.mm();
    Interpreter interpreter(frame, mill, mill, mill, {});
    CompVerdict out;
    out.corners = contour.pieces.size();
    if (run_text(interpreter, program) == Step::PROGRAM_END) {
        weigh(contour, recorder, out);
    } else {
        const diagnostics::Diagnostic &error = interpreter.error();
        explain(contour, error.what.place.line, error.str(), out);
    }
    return out;
}

inline CompVerdict judge_contour(const CompContour &contour) {
    return judge_contour(contour, program_of(contour));
}

}  // namespace mw::gcode::test
