// SPDX-License-Identifier: GPL-2.0-or-later
// Converts program coordinates to machine coordinates: maps each CanonCall to MachineCalls.
#pragma once

#include <string>
#include <string_view>

#include "gcode/canon/canon.hh"
#include "gcode/canon/machine_canon.hh"

namespace mw::gcode {

/// Applies program units, coordinate systems, G92, rotation, tool offset, planes and feed modes. Moves reach
/// the MachineCanon with all nine coordinates in machine units. Any thread, one at a time.
class MachineFrame final : public Canon {
  public:
    MachineFrame(MachineCanon &target, LengthUnits machine_units);

    /// Sets the position of the machine [machine units, machine coordinates] after start, stop, abort, probe
    /// or tool change. The next move starts there.
    void set_position(const Pose &machine) { position_ = machine; }
    const Pose &position() const { return position_; }
    /// A position of the machine in program coordinates and units.
    Pose to_program(const Pose &machine) const;
    Pose to_machine(const Pose &program) const;

    /// The state as bytes, and the inverse; false when the bytes are not valid.
    std::string pack() const;
    bool unpack(std::string_view bytes);

    void begin_block(const BlockRef &block) override { target_->begin_block(block); }
    void take(const CanonCall &call) override;

  private:
    template <class Io, class Frame>
    static void fields(Io &io, Frame &frame);
    /// Calls that only change the frame and the settings of later calls.
    void follow(const UseLengthUnits &call) { units_ = call.units; }
    void follow(const SelectPlane &call) { plane_ = call.plane; }
    void follow(const SetFeedRate &call) { feed_ = call.rate * length_factor(); }
    void follow(const SetFeedMode &call);
    void follow(const SetMotionControlMode &call);
    void follow(const SetNaivecamTolerance &call) { naivecam_ = call.tolerance * length_factor(); }
    void follow(const StartSpeedFeedSynch &call);
    void follow(const StopSpeedFeedSynch &call);
    void convert(const SetG5xOffset &call);
    void convert(const SetG92Offset &call);
    void convert(const SetXyRotation &call);
    void convert(const UseToolLengthOffset &call);
    void convert(const SetPlannerMode &call);
    void convert(const StraightTraverse &call);
    void convert(const StraightFeed &call) { feed_to(call.end); }
    void convert(const ArcFeed &call);
    void convert(const NurbsFeed &call);
    void convert(const StraightProbe &call);
    void convert(const RigidTap &call);
    void convert(const SetSpindleSpeed &call);

    void feed_to(const Pose &end);
    /// Scripts may name any spindle; false, with an error, when it does not exist.
    bool hasSpindle(int spindle);
    double length_factor() const;  ///< program units to machine units
    Pose to_machine_units(const Pose &program) const;
    void announce_offsets();
    /// Settings of a feed move; `linear` is false for moves of A, B and C alone, whose feed is in degrees.
    MoveSettings feed_settings(bool linear) const;
    MoveSettings rapid_settings() const;
    void turn(ArcMove &move, const ArcFeed &arc) const;

    MachineCanon *target_;
    LengthUnits machine_units_;
    LengthUnits units_ = LengthUnits::MM;
    Plane plane_ = Plane::XY;
    Pose position_;          ///< machine units
    Pose g5x_, g92_, tool_;  ///< machine units
    int g5x_index_ = 1;
    double rotation_deg_ = 0;
    double feed_ = 0;  ///< as programmed
    FeedMode feed_mode_ = FeedMode::UNITS_PER_MINUTE;
    geometry::PathMode control_ = geometry::PathMode::BLEND;
    double tolerance_ = 0, naivecam_ = 0;  ///< machine units
    double corner_scale_ = 0;
    double synch_feed_ = 0;  ///< machine units per revolution; 0 off
    int synch_spindle_ = 0;
    bool velocity_synched_ = false;
};

}  // namespace mw::gcode
