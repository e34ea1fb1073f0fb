// SPDX-License-Identifier: GPL-2.0-or-later
// Spans along the programmed path itself, for moves that are followed exactly (G61, G61.1).
//
// Lines are reproduced. Arcs and helices are divided into parts. The polynomial of degree five for each part
// has the position and the first two derivatives of the arc at both ends. Between two moves, derivatives may
// jump; the seams contain these jumps.
#pragma once

#include <vector>

#include "trajectory/curve/spline.hh"
#include "trajectory/path/primitive.hh"

namespace mw::trajectory::curve {

/// A point where two spans with different derivatives meet, with the derivatives on both sides.
struct Seam {
    double s = 0;
    CurvePoint before, after;
};

/// The seam between the end of a span and the start of the next one. [planner]
Seam seam_between(const Span &before, const Span &after) noexcept;

/// Use it in the planner thread only. Every span is final when its move is added.
class ExactBuilder {
  public:
    /// `widest`: maximum length of a span [unit].
    explicit ExactBuilder(double widest) noexcept : widest_(widest) {}

    /// The next move starts at path length `s`, without a seam before it.
    void begin(double s = 0) noexcept;
    /// Adds a move. Returns false and adds nothing if its length is not above 0.
    bool add(const Primitive &primitive);

    /// Appends the spans and seams to `spans` and `seams` and removes them from the builder.
    void move_spans(std::vector<Span> &spans, std::vector<Seam> &seams);
    const std::vector<Span> &spans() const noexcept { return spans_; }
    /// The seams between successive moves, in order.
    const std::vector<Seam> &seams() const noexcept { return seams_; }
    double final_s() const noexcept { return final_s_; }

    /// Bound of the distance of a span from its arc, divided by the radius of the arc.
    static constexpr double LARGEST_ERROR = 1e-9;

  private:
    void add_line(const Primitive &line, int parts);
    void add_arc(const Primitive &arc, int parts);

    double widest_;
    double final_s_ = 0;
    bool is_first_ = true;
    Span last_;  ///< last span, for the seam before the next move
    std::vector<Span> spans_;
    std::vector<Seam> seams_;
};

}  // namespace mw::trajectory::curve
