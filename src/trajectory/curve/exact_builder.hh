// SPDX-License-Identifier: GPL-2.0-or-later
// Spans along the programmed path itself, for moves that are followed exactly (G61, G61.1).
//
// Lines are reproduced. Arcs and helices are cut into parts; each becomes the polynomial of degree five that
// has the position and the first two derivatives of the arc at both ends. Where two moves meet, derivatives
// may jump: the seams report by how much.
#pragma once

#include <vector>

#include "trajectory/curve/spline.hh"
#include "trajectory/path/primitive.hh"

namespace mw::trajectory::curve {

/// A place where two spans meet whose derivatives differ: the curve on both sides of it.
struct Seam {
    double s = 0;
    CurvePoint before, after;
};

/// [planner] The end of a span and the start of the next one.
Seam seam_between(const Span &before, const Span &after) noexcept;

/// Planner thread. Every span is final as soon as its move is added.
class ExactBuilder {
  public:
    /// `widest`: largest length of a span [units].
    explicit ExactBuilder(double widest) noexcept : widest_(widest) {}

    /// The next move starts at the place `s`; there is no seam before it.
    void begin(double s = 0) noexcept;
    /// Adds nothing and returns false if the length of the move is not above 0.
    bool add(const Primitive &primitive);

    /// Appends what there is to `spans` and `seams`; the builder forgets it.
    void move_spans(std::vector<Span> &spans, std::vector<Seam> &seams);
    const std::vector<Span> &spans() const noexcept { return spans_; }
    /// One for each two moves that meet, in order.
    const std::vector<Seam> &seams() const noexcept { return seams_; }
    double final_s() const noexcept { return final_s_; }

    /// Largest distance of a span from its arc over the radius of the arc: this bound is kept.
    static constexpr double LARGEST_ERROR = 1e-9;

  private:
    void add_line(const Primitive &line, int parts);
    void add_arc(const Primitive &arc, int parts);

    double widest_;
    double final_s_ = 0;
    bool is_first_ = true;
    Span last_;  ///< before the next move
    std::vector<Span> spans_;
    std::vector<Seam> seams_;
};

}  // namespace mw::trajectory::curve
