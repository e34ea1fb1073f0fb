// SPDX-License-Identifier: GPL-2.0-or-later
// Fits a spline to the programmed path within its tolerance, while moves are still added.
//
// Control point i is the average of the programmed path around its parameter, shifted by half of the variance
// of the spline's weights times the second difference. So lines and parabolas are reproduced. The knot
// spacing is as wide as the tolerance allows. One rule covers corners, arcs and short chords.
#pragma once

#include <cstddef>
#include <vector>

#include "trajectory/curve/programmed_path.hh"
#include "trajectory/curve/spline.hh"

namespace mw::trajectory::curve {

/// Maximum change of the knot spacing per unit of path length.
inline constexpr double SPACING_GROWTH = 0.25;

/// Soft limits that the curve must keep.
struct Room {
    /// A joint that moves in proportion to axes: low <= slope p <= high.
    struct Row {
        Pose slope;
        double low = 0, high = 0;
    };
    Pose low, high;
    std::vector<Row> rows;
};

/// Use it in the planner thread only. It stores the moves and knots of the part that is not final, and the
/// spans until they are moved out.
class CurveBuilder {
  public:
    /// `widest`: maximum knot spacing [unit].
    explicit CurveBuilder(double widest);

    /// Sets the soft limits, from the next begin() on; initially none. The curve stays within them if the
    /// programmed path does. Otherwise it exceeds them by at most as much as the path.
    void set_room(Room room) noexcept;
    /// Begins a curve at the start of the next move, at path length `s`.
    void begin(double s = 0) noexcept;
    /// Adds a move. `tolerance`: maximum distance of the curve from the move, checked separately for lengths
    /// and angles. Returns false and adds nothing if the tolerance or the length is not above 0.
    bool add(const Primitive &primitive, double tolerance);
    /// Makes spans of the added moves. `complete`: no move follows, so all spans are made. Otherwise the end
    /// remains open where a next move can change it.
    void extend(bool complete);

    /// Path length at the end of the programmed path.
    double programmed_length() const noexcept { return path_.length(); }
    /// The final spans.
    const std::vector<Span> &spans() const noexcept { return spans_; }
    /// Appends the final spans to `spans` and removes them from the builder.
    void move_spans(std::vector<Span> &spans);
    double final_s() const noexcept { return spans_.empty() ? start_s_ : spans_.back().end_s(); }
    /// Maximum of the deviation divided by the tolerance until now. It is a bound of the deviation, not a
    /// sample.
    double worst_deviation() const noexcept { return final_worst_; }
    /// Number of fits since begin().
    int rounds() const noexcept { return rounds_; }

  private:
    /// A limit of the knot spacing at one point of the path.
    struct Cap {
        double s = 0, spacing = 0;
        bool is_corner = false;
    };
    void spread_caps();
    void lay_knots();
    void lay_between(double from, double to, std::size_t cap);
    double spacing_at(double s, std::size_t &cap) const noexcept;
    void place_controls();
    Pose kept_in_room(const Pose &control, const Pose &mean) const noexcept;
    Span span_of(std::size_t k) const noexcept;
    /// A span that is not final, with its deviation divided by the tolerance.
    struct OpenSpan {
        Span span;
        double worst = UNKNOWN;
    };
    /// The open spans of a round, with their knots.
    struct Fit {
        std::vector<double> knots;
        std::size_t first = 0;  ///< number of the first of these spans in the knot row
        std::vector<OpenSpan> spans;
    };
    bool hasSameKnots(std::size_t k, const Fit &fit, std::size_t of_fit) const noexcept;
    void make_spans();
    bool check();
    double check_span(const Span &span, std::size_t &move);
    void narrow(double s, double excess, double length);
    void keep_final(bool complete);

    static Room endless() noexcept;
    static constexpr double UNKNOWN = -1;

    double widest_;
    double start_s_ = 0;  ///< start of the curve, or end of the spans that were moved out
    Room next_room_ = endless(), room_ = endless();
    ProgrammedPath path_;
    std::vector<Cap> caps_, found_;
    bool is_narrowed_ = false;
    std::vector<double> envelope_;
    // The knots: first `fixed_` knots of final spans, then the knots of the open part.
    std::vector<double> knots_;
    std::size_t fixed_ = 1;
    std::size_t first_open_ = 0;  ///< number of the first open span in the knot row
    std::vector<double> places_;
    std::vector<Pose> controls_, means_;
    std::vector<Span> spans_;
    std::vector<OpenSpan> open_;
    Fit last_fit_;  ///< fit of the previous round; spans with the same knots are reused
    double worst_ = 0, final_worst_ = 0;
    int rounds_ = 0;
};

}  // namespace mw::trajectory::curve
