// SPDX-License-Identifier: GPL-2.0-or-later
// A programmed move as a curve: points on it, and the nearest one to a place.
#pragma once

#include <cmath>

#include "base/geometry/pose.hh"

namespace mw::machine {

/// A programmed move with its start position.
struct ProgrammedPiece {
    geometry::Pose start, end;
    geometry::Pose centre, normal;  ///< arcs only
    double angle_rad = 0;           ///< 0: a line
    bool isRapid = false;
};

/// The nearest point of a piece: the position along it and the distances in both groups of coordinates.
struct Nearest {
    double fraction = 0;  ///< 0 start, 1 end
    double linear = 0;    ///< over XYZUVW [machine units]
    double angular = 0;   ///< over ABC [degrees]
    double combined() const { return angular == 0 ? linear : std::hypot(linear, angular); }
};

/// Length over XYZ, else UVW, else ABC: the feed length.
double feed_length(const ProgrammedPiece &piece);

/// Precomputed values of a piece, for calculating many points.
class PieceShape {
  public:
    explicit PieceShape(const ProgrammedPiece &piece);

    const ProgrammedPiece &piece() const { return piece_; }
    /// The pose at a fraction of the piece.
    geometry::Pose point_at(double fraction) const;
    Nearest nearest(const geometry::Pose &p) const;

  private:
    struct Vec3 {
        double x = 0, y = 0, z = 0;
    };
    static Vec3 minus(const geometry::Pose &a, const geometry::Pose &b);
    static double dot(const Vec3 &a, const Vec3 &b);
    static Vec3 cross(const Vec3 &a, const Vec3 &b);
    static Vec3 in_plane(const Vec3 &v, const Vec3 &normal);
    /// Distance of `p` from the point `at` at `fraction`.
    static Nearest distance(const geometry::Pose &p, const geometry::Pose &at, double fraction);
    /// Only X, Y and Z of `p` can deviate from the piece.
    bool isInSpace(const geometry::Pose &p) const;
    Nearest nearest_in_space(const geometry::Pose &p) const;
    Nearest nearest_on_line(const geometry::Pose &p) const;
    Nearest nearest_on_arc(const geometry::Pose &p) const;

    ProgrammedPiece piece_;
    geometry::Pose along_;  ///< end - start
    double length2_ = 0;
    bool line_in_space_ = false;  ///< moves X, Y and Z only
    // For an arc: its radius at the start, the same rotated by 90 degrees, the growth of the radius, and the
    // rise.
    Vec3 normal_, radius_, side_;
    double growth_ = 0, first_rise_ = 0, rise_ = 0;
    geometry::Pose first_, last_;  ///< point_at(0), point_at(1)
};

}  // namespace mw::machine
