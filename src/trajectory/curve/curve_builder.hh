// SPDX-License-Identifier: GPL-2.0-or-later
// Fits a spline to the programmed path within its tolerance, while moves are still added.
//
// Control point i is the mean position of the programmed path around its place, moved by half of the variance
// of the spline's weights times the second difference there: lines and parabolas are reproduced. The spacing
// of the knots is as wide as the tolerance allows. One rule for corners, arcs and short chords.
#pragma once

#include <cstddef>
#include <vector>

#include "trajectory/curve/programmed_path.hh"
#include "trajectory/curve/spline.hh"

namespace mw::trajectory::curve {

/// Change of the knot spacing per length of the path.
inline constexpr double SPACING_GROWTH = 0.25;

/// Where a curve may go.
struct Room {
    /// A joint that moves in proportion to axes: low <= slope p <= high.
    struct Row {
        Pose slope;
        double low = 0, high = 0;
    };
    Pose low, high;
    std::vector<Row> rows;
};

/// Planner thread. Memory: the moves and knots of the part that is not yet final, and the spans until they
/// are dropped.
class CurveBuilder {
  public:
    /// `widest`: largest knot spacing [units].
    explicit CurveBuilder(double widest);

    /// Soft limits, from the next begin() on: the curve stays within them where the programmed path does, and
    /// leaves them no farther than the path elsewhere. None at first.
    void set_room(Room room) noexcept;
    /// A curve begins at the start of the next move, whose place is `s`.
    void begin(double s = 0) noexcept;
    /// `tolerance`: largest distance of the curve from the move, lengths and angles apart.
    /// Adds nothing and returns false if the tolerance or the length of the move is not above 0.
    bool add(const Primitive &primitive, double tolerance);
    /// Makes spans of what has been added; `complete`: nothing follows, so all of it. Otherwise the end stays
    /// open where a next move can change it.
    void extend(bool complete);

    /// Place of the end of the programmed path: its length if the curve begins at 0.
    double programmed_length() const noexcept { return path_.length(); }
    /// Spans that do not change any more.
    const std::vector<Span> &spans() const noexcept { return spans_; }
    /// Appends the final spans to `spans`; the builder forgets them.
    void move_spans(std::vector<Span> &spans);
    double final_s() const noexcept { return spans_.empty() ? start_s_ : spans_.back().end_s(); }
    /// Largest deviation so far over the tolerance there: a bound of it, not a sample.
    double worst_deviation() const noexcept { return final_worst_; }
    /// Fits of the open part until it was within the tolerance.
    int rounds() const noexcept { return rounds_; }

  private:
    /// A place where knots may not be wider apart.
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
    /// A span that is not final, and its deviation over the tolerance.
    struct OpenSpan {
        Span span;
        double worst = UNKNOWN;
    };
    /// The open spans of a round, and the knots that they were made from.
    struct Fit {
        std::vector<double> knots;
        std::size_t first = 0;  ///< span of the row of knots that is the first one
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
    double start_s_ = 0;  ///< of the curve; later, end of the spans that were moved out
    Room next_room_ = endless(), room_ = endless();
    ProgrammedPath path_;
    std::vector<Cap> caps_, found_;
    bool is_narrowed_ = false;
    std::vector<double> envelope_;
    // Knots: first those of spans that are final, `fixed_` of them; then those of the open part.
    std::vector<double> knots_;
    std::size_t fixed_ = 1;
    std::size_t first_open_ = 0;  ///< span of the row of knots that is the first one not final
    std::vector<double> places_;
    std::vector<Pose> controls_, means_;
    std::vector<Span> spans_;
    std::vector<OpenSpan> open_;
    Fit last_fit_;  ///< of the round before: what has the same knots stays the same
    double worst_ = 0, final_worst_ = 0;
    int rounds_ = 0;
};

}  // namespace mw::trajectory::curve
