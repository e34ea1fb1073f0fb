// SPDX-License-Identifier: GPL-2.0-or-later
// A programmed move as a curve: points on it, and the point nearest to a position.
#pragma once

#include <algorithm>

#include "base/geometry/pose.hh"

namespace mw::gcode {

/// A programmed move with its start position.
struct ProgrammedPiece {
    geometry::Pose start, end;
    geometry::Pose centre, normal;  ///< only for arcs
    double angle_rad = 0;           ///< 0: a line
    bool isRapid = false;
    bool isInUvw = false;  ///< the arc is in U, V and W
};

/// The nearest point of a piece: the position along it and the distances in both groups of coordinates.
struct Nearest {
    double fraction = 0;  ///< 0 start, 1 end
    double linear = 0;    ///< over XYZUVW [machine units]
    double angular = 0;   ///< over ABC [degrees]
    /// G64 P limits lengths and degrees separately by the same number.
    double distance() const { return std::max(linear, angular); }
};

/// Uncertainty of distances.
struct Slack {
    double linear = 0, angular = 0;
};

/// Length over XYZ, else UVW, else ABC: the feed length.
double feed_length(const ProgrammedPiece &piece);

/// Precomputed values of a piece, for calculating many points. An arc has at most half a revolution; longer
/// arcs are divided (part_of()).
class PieceShape {
  public:
    explicit PieceShape(const ProgrammedPiece &piece);

    const ProgrammedPiece &piece() const { return piece_; }
    /// The pose at a fraction of the piece.
    geometry::Pose point_at(double fraction) const;
    /// The point with the smallest distance() to `p` among the fractions from `from` to 1. `slack` is
    /// subtracted from distances, which are never negative.
    Nearest nearest(const geometry::Pose &p, double from = 0, const Slack &slack = {}) const;
    /// Part `index` of `count` parts with equal length.
    ProgrammedPiece part_of(int index, int count) const;

  private:
    struct Vec3 {
        double x = 0, y = 0, z = 0;
    };
    static double dot(const Vec3 &a, const Vec3 &b);
    static Vec3 cross(const Vec3 &a, const Vec3 &b);
    static Vec3 in_plane(const Vec3 &v, const Vec3 &normal);
    /// The three coordinates of the arc.
    Vec3 arc_axes(const geometry::Pose &p) const;
    void add_to_arc_axes(geometry::Pose &p, double along_radius, double along_side) const;
    geometry::Pose derivative_at(double fraction) const;
    Nearest at(const geometry::Pose &p, double fraction, const Slack &slack) const;
    /// The fraction that is nearest in lengths alone, or in angles alone; may be outside of the piece.
    double linear_fraction(const geometry::Pose &p) const;
    double angular_fraction(const geometry::Pose &p) const;
    double arc_fraction(const geometry::Pose &p) const;

    ProgrammedPiece piece_;
    geometry::Pose along_;       ///< end - start, without the part on the circle
    double linear_length2_ = 0;  ///< square of the length of along_
    double angular_length2_ = 0;
    // For an arc: the radius at the start, the same vector rotated by 90 degrees, and the increase of the
    // radius.
    Vec3 normal_, radius_, side_;
    double growth_ = 0;
    bool isCircle_ = false;  ///< an arc that is not a helix or spiral and moves no other length
};

}  // namespace mw::gcode
