// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/canon/machine_frame.hh"

#include <cmath>
#include <numbers>
#include <string>

#include "base/bytes.hh"
#include "base/limits.hh"
#include "gcode/canon/frame.hh"
#include "gcode/canon/nurbs.hh"
#include "gcode/canon/plane_axes.hh"

namespace mw::gcode {
namespace {

constexpr double MM_PER_INCH = 25.4;
constexpr double FULL_TURN = 2.0 * std::numbers::pi;
/// If start and end of an arc differ by less than this angle, it is a full circle [rad].
constexpr double SAME_ANGLE = 1e-10;

struct FeedLength {
    double length = 0;
    bool linear = true;  ///< false: only A, B or C move
};

FeedLength feed_length(const Pose &from, const Pose &to) {
    const Pose way = to - from;
    if (const double xyz = geometry::norm_xyz(way); xyz > 0.0) {
        return {xyz, true};
    }
    if (const double uvw = geometry::norm_uvw(way); uvw > 0.0) {
        return {uvw, true};
    }
    return {geometry::norm_abc(way), false};
}

}  // namespace

MachineFrame::MachineFrame(MachineCanon &target, LengthUnits machine_units)
    : target_(&target), machine_units_(machine_units), units_(machine_units) {}

double MachineFrame::length_factor() const {
    if (units_ == machine_units_) {
        return 1.0;
    }
    return machine_units_ == LengthUnits::MM ? MM_PER_INCH : 1.0 / MM_PER_INCH;
}

Pose MachineFrame::to_machine_units(const Pose &program) const {
    return detail::scale_lengths(program, length_factor());
}

Pose MachineFrame::to_machine(const Pose &program) const {
    return detail::Frame{g5x_, g92_, tool_, rotation_deg_}.to_machine(to_machine_units(program));
}

Pose MachineFrame::to_program(const Pose &machine) const {
    return detail::scale_lengths(detail::Frame{g5x_, g92_, tool_, rotation_deg_}.to_program(machine),
                                 1.0 / length_factor());
}

void MachineFrame::take(const CanonCall &call) {
    std::visit(
        Overloaded{
            [this](const OneOf<UseLengthUnits, SelectPlane, SetFeedRate, SetFeedMode, SetMotionControlMode,
                               SetNaivecamTolerance, StartSpeedFeedSynch, StopSpeedFeedSynch> auto &one) {
                follow(one);
            },
            [this](const OneOf<SetG5xOffset, SetG92Offset, SetXyRotation, UseToolLengthOffset, SetPlannerMode,
                               StraightTraverse, StraightFeed, ArcFeed, NurbsFeed, StraightProbe, RigidTap,
                               SetSpindleSpeed> auto &one) { convert(one); },
            [this](const OneOf<SetSpindleMode, StartSpindle> auto &one) {
                if (hasSpindle(one.spindle)) {
                    target_->take(one);
                }
            },
            [this](const OneOf<Dwell, StopSpindle, OrientSpindle, WaitOrientComplete, SelectTool, ChangeTool,
                               ChangeToolNumber, SetToolTableEntry, ReloadTools, SwitchMist, SwitchFlood,
                               SwitchFeedOverride, SwitchSpeedOverride, SwitchFeedHold, SwitchAdaptiveFeed,
                               SetDigitalOutput, SetAnalogOutput, WaitInput, ProgramStop, ProgramEnd,
                               PalletShuttle, Finish, UserCode, ProgramComment, OperatorMessage, PrintLine,
                               OpenLog, LogLine, CloseLog, LogProbes, CanonError> auto &one) {
                target_->take(one);
            },
            [](const OneOf<OnReset, SetFeedReference> auto &) {},
        },
        call);
}

void MachineFrame::announce_offsets() {
    target_->take(UseOffsets{g5x_index_, g5x_, g92_, rotation_deg_});
}

void MachineFrame::convert(const SetG5xOffset &call) {
    g5x_index_ = call.index;
    g5x_ = to_machine_units(call.offset);
    announce_offsets();
}

void MachineFrame::convert(const SetG92Offset &call) {
    g92_ = to_machine_units(call.offset);
    announce_offsets();
}

void MachineFrame::convert(const SetXyRotation &call) {
    rotation_deg_ = call.angle_deg;
    announce_offsets();
}

void MachineFrame::convert(const UseToolLengthOffset &call) {
    tool_ = to_machine_units(call.offset);
    target_->take(UseToolOffset{tool_});
}

bool MachineFrame::hasSpindle(int spindle) {
    if (spindle >= 0 && spindle < MAX_SPINDLES) {
        return true;
    }
    target_->take(CanonError{"There is no spindle " + std::to_string(spindle) + ": 0 to " +
                             std::to_string(MAX_SPINDLES - 1)});
    return false;
}

void MachineFrame::follow(const SetFeedMode &call) {
    if (!hasSpindle(call.spindle)) {
        return;
    }
    feed_mode_ = call.mode;
    if (call.mode == FeedMode::UNITS_PER_REVOLUTION) {
        synch_spindle_ = call.spindle;
    }
}

void MachineFrame::follow(const SetMotionControlMode &call) {
    control_ = call.mode;
    tolerance_ = call.tolerance * length_factor();
}

void MachineFrame::convert(const SetPlannerMode &call) {
    corner_scale_ = call.type != 0 ? call.peak_scale : 0.0;
    target_->take(UsePlanner{call.type != 0});
}

MoveSettings MachineFrame::rapid_settings() const {
    MoveSettings out;
    out.isRapid = true;
    out.mode = control_;
    out.tolerance = tolerance_;
    out.naivecam_tolerance = naivecam_;
    out.corner_scale = corner_scale_;
    return out;
}

MoveSettings MachineFrame::feed_settings(bool linear) const {
    MoveSettings out = rapid_settings();
    out.isRapid = false;
    out.feed_per_revolution = synch_feed_;
    out.synch_spindle = static_cast<std::int8_t>(synch_spindle_);
    out.velocity_synched = velocity_synched_;
    constexpr double SECONDS_PER_MINUTE = 60.0;
    if (feed_mode_ == FeedMode::UNITS_PER_REVOLUTION && synch_feed_ == 0.0) {
        out.feed_per_revolution = feed_;
        out.velocity_synched = true;
        // The feed at one revolution per second; the planner multiplies it by the spindle speed.
        out.feed = feed_;
        return out;
    }
    // Degrees per minute are not lengths, so the length factor is removed.
    out.feed = feed_ / SECONDS_PER_MINUTE / (linear ? 1.0 : length_factor());
    return out;
}

void MachineFrame::convert(const StraightTraverse &call) {
    const Pose to = to_machine(call.end);
    target_->take(LineMove{to, rapid_settings()});
    position_ = to;
}

void MachineFrame::feed_to(const Pose &end) {
    const Pose to = to_machine(end);
    const FeedLength way = feed_length(position_, to);
    target_->take(LineMove{to, feed_settings(way.linear)});
    position_ = to;
}

/// Sets centre, normal and angle.
void MachineFrame::turn(ArcMove &move, const ArcFeed &arc) const {
    const detail::PlaneAxes axes = detail::plane_axes(plane_);
    const Pose start = to_program(position_);
    Pose centre = start;
    centre[axes.first] = arc.first_centre;
    centre[axes.second] = arc.second_centre;
    move.centre = to_machine(centre);
    move.normal = {};
    move.normal[axes.normal] = 1.0;
    if (axes.normal < geometry::AXIS_A) {
        detail::rotate_xy(move.normal, rotation_deg_);
    }
    const double x0 = start[axes.first] - arc.first_centre, y0 = start[axes.second] - arc.second_centre;
    const double x1 = arc.first_end - arc.first_centre, y1 = arc.second_end - arc.second_centre;
    double angle = std::atan2(x0 * y1 - y0 * x1, x0 * x1 + y0 * y1);
    if (arc.rotation > 0) {
        angle += angle < SAME_ANGLE ? FULL_TURN : 0.0;
        angle += FULL_TURN * (arc.rotation - 1);
    } else {
        angle -= angle > -SAME_ANGLE ? FULL_TURN : 0.0;
        angle -= FULL_TURN * (-arc.rotation - 1);
    }
    move.angle_rad = angle;
}

void MachineFrame::convert(const ArcFeed &arc) {
    if (arc.rotation == 0) {
        feed_to(arc.end);
        return;
    }
    ArcMove move;
    move.end = to_machine(arc.end);
    turn(move, arc);
    move.settings = feed_settings(true);
    target_->take(move);
    position_ = move.end;
}

void MachineFrame::convert(const NurbsFeed &nurbs) {
    // Far below the resolution of a machine.
    constexpr double TOLERANCE_MM = 0.0002;
    const detail::PlaneAxes axes = detail::plane_axes(plane_);
    const double inches = TOLERANCE_MM / 25.4;
    const std::vector<PlanePiece> pieces =
        approximate(nurbs, units_ == LengthUnits::MM ? TOLERANCE_MM : inches);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const PlanePiece &piece = pieces[i];
        Pose end = nurbs.end;
        if (i + 1 < pieces.size()) {
            end[axes.first] = piece.first_end;
            end[axes.second] = piece.second_end;
        }
        convert(ArcFeed{end[axes.first], end[axes.second], piece.first_centre, piece.second_centre,
                        piece.rotation, end[axes.normal], end});
    }
}

void MachineFrame::convert(const StraightProbe &call) {
    const Pose to = to_machine(call.end);
    const FeedLength way = feed_length(position_, to);
    target_->take(ProbeMove{to, feed_settings(way.linear), call.kind});
    position_ = to;
}

void MachineFrame::convert(const RigidTap &call) {
    Pose end = to_program(position_);
    end[geometry::AXIS_X] = call.x;
    end[geometry::AXIS_Y] = call.y;
    end[geometry::AXIS_Z] = call.z;
    const Pose to = to_machine(end);
    const FeedLength way = feed_length(position_, to);
    target_->take(TapMove{to, feed_settings(way.linear), call.scale});
    // The tool returns to the start, so the position does not change.
}

void MachineFrame::follow(const StartSpeedFeedSynch &call) {
    if (!hasSpindle(call.spindle)) {
        return;
    }
    synch_spindle_ = call.spindle;
    synch_feed_ = call.feed_per_revolution * length_factor();
    velocity_synched_ = call.isVelocityMode;
}

void MachineFrame::follow(const StopSpeedFeedSynch &) {
    synch_feed_ = 0.0;
    velocity_synched_ = false;
}

void MachineFrame::convert(const SetSpindleSpeed &call) {
    if (!hasSpindle(call.spindle)) {
        return;
    }
    constexpr double MM_IN_METRE = 1000.0, INCHES_IN_FOOT = 12.0;
    const double length = units_ == LengthUnits::INCH ? INCHES_IN_FOOT : MM_IN_METRE;
    target_->take(UseSpindleSpeed{call.spindle, call.speed, length * length_factor()});
}

/// `frame` is const when packing.
template <class Io, class Frame>
void MachineFrame::fields(Io &io, Frame &frame) {
    io.choice(frame.units_, LengthUnits::MM);
    io.choice(frame.plane_, Plane::UW);
    for (auto *pose : {&frame.position_, &frame.g5x_, &frame.g92_, &frame.tool_}) {
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            io((*pose)[axis]);
        }
    }
    io(frame.g5x_index_);
    io(frame.rotation_deg_);
    io(frame.feed_);
    io.choice(frame.feed_mode_, FeedMode::UNITS_PER_REVOLUTION);
    io.choice(frame.control_, geometry::PathMode::BLEND);
    io(frame.tolerance_);
    io(frame.naivecam_);
    io(frame.corner_scale_);
    io(frame.synch_feed_);
    io(frame.synch_spindle_);
    io(frame.velocity_synched_);
}

std::string MachineFrame::pack() const {
    Packer out;
    fields(out, *this);
    return out.bytes();
}

bool MachineFrame::unpack(std::string_view bytes) {
    Unpacker in(bytes);
    MachineFrame frame = *this;
    fields(in, frame);
    const bool is_spindle = frame.synch_spindle_ >= 0 && frame.synch_spindle_ < MAX_SPINDLES;
    if (!in.isComplete() || !is_spindle) {
        return false;
    }
    *this = frame;
    return true;
}

}  // namespace mw::gcode
