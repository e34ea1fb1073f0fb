// SPDX-License-Identifier: GPL-2.0-or-later
// Cutter radius compensation: offsets the path by the tool's radius to the left or right in the selected
// plane.
#pragma once

#include <string_view>

#include "gcode/canon/canon_queue.hh"
#include "gcode/canon/plane_axes.hh"
#include "gcode/interpreter/codes/comp/comp_corner.hh"
#include "gcode/interpreter/gcode.hh"
#include "gcode/syntax/fault.hh"

namespace mw::gcode::detail {

/// Start of a move, and the modes that its values depend on.
struct CompPlace {
    const Pose &position;  ///< as programmed [program units]
    Plane plane = Plane::XY;
    LengthUnits units = LengthUnits::MM;
};

/// The end of a move is final only when the next move is known: in a concave corner both offset paths are cut
/// at their intersection, at a convex corner an arc is inserted. The last move therefore remains in the
/// queue. A plain value: a copy can undo a block; the queue undoes changed calls.
class Compensation {
  public:
    /// G41 and G42; [program units]
    void turn_on(CompSide side, GCode code, double radius, int orientation);
    /// Ends compensation. If the tool is offset from the contour, the next move must be straight.
    void turn_off();
    /// G40: turn_off(), with a comment.
    void end(CanonQueue &canon);
    /// Treats the next move as the first move.
    void forget_move() { last_ = {}; }

    /// A straight move; false after setting the fault.
    bool move_straight(const CompPlace &place, bool rapid, const Pose &end, CanonQueue &canon, Fault &fault);
    bool move_along_arc(const CompPlace &place, const ArcPlan &arc, CanonQueue &canon, Fault &fault);

    bool isOn() const { return side_ != CompSide::OFF; }
    /// True if there was a move since compensation was switched on.
    bool hasMoved() const { return last_.set; }
    CompSide side() const { return side_; }
    GCode code() const { return code_; }
    double radius() const { return radius_; }
    int orientation() const { return orientation_; }
    /// True if compensation has been switched off, so that the next move must be straight.
    bool isExit() const { return is_exit_; }
    void set_exit(bool is_exit) { is_exit_ = is_exit; }
    /// Position of the tool for the programmed `position`.
    Pose compensated(const Pose &position, Plane plane) const;

    /// The first call that must remain in the queue, because its end may change.
    std::size_t held_call() const { return last_.record; }
    bool isHolding() const { return isOn() && last_.set; }
    void set_held_call(std::size_t call) { last_.record = call; }

    bool operator==(const Compensation &) const = default;

  private:
    Point shift(Plane plane) const;
    Pose in_plane(Pose pose, Point point, Plane plane) const;
    void send_arc(Point to, Point centre, int rotation, const Pose &end, Plane plane,
                  CanonQueue &canon) const;
    void send_rapid_around(const CompPlace &place, Point to, Point corner, CanonQueue &canon) const;
    void end_last_at(Point end, Plane plane, CanonQueue &canon);
    bool join(const CompPlace &place, CompElement &next, bool rapid, std::string_view what, CanonQueue &canon,
              Fault &fault);
    bool enter_by_arc(const CompPlace &place, const ArcPlan &arc, CompElement &next, Fault &fault) const;

    CompSide side_ = CompSide::OFF;
    GCode code_ = G(40);
    double radius_ = 0;  ///< [program units]
    int orientation_ = 0;
    CompElement last_;
    bool is_exit_ = false;
};

}  // namespace mw::gcode::detail
