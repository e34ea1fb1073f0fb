// SPDX-License-Identifier: GPL-2.0-or-later
// A random machine: the contents of its INI and HAL files, and its plant models. The judge reads limits from
// this structure, as they are written to the files, and never from the product.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "components/plants/axis.hh"
#include "components/plants/random.hh"
#include "components/plants/spindle_plant.hh"

namespace mw::campaign {

enum class HomeKind { IMMEDIATE, SWITCH, SWITCH_AND_INDEX };

struct JointDesign {
    bool isAngular = false;
    double velocity = 100, acceleration = 1000;
    double jerk = 0;  ///< 0: none
    double low = -100, high = 100;
    double ferror = 2, min_ferror = 1;
    double backlash = 0;  ///< [JOINT_n]BACKLASH; 0: none
    int screw_type = -1;  ///< [JOINT_n]COMP_FILE_TYPE; below 0: no table
    HomeKind home_kind = HomeKind::IMMEDIATE;
    double home = 0, home_offset = 0, search = 0, latch = 0;
    int sequence = 0;
    // --- the plant
    double play = 0;                                            ///< backlash between motor and slide
    double screw_error = 0, screw_wave = 100, screw_phase = 0;  ///< a sine [units, units, rad]
    double shaft_offset = 0;  ///< shaft position of the motor at joint position 0
    double start = 0;         ///< joint position at the start
    double counts_per_unit = 1e4;
    double index_spacing = 0;
    double index_at = 0;                     ///< position of the joint at one of the marks
    double bounce_s = 0, hysteresis = 0.02;  ///< bounce time and hysteresis of the home switch
    double home_switch_at = 0;               ///< closed at and below this position
    plants::AxisSettings drive;

    bool isCorrected() const { return backlash > 0 || screw_type >= 0; }
    /// Overlap of a screw table outside the soft limits; farther out the screw error is unknown.
    static constexpr double TABLE_BEYOND = 6, TABLE_STEP = 1;
    bool isInTable(double x) const {
        return screw_type < 0 || (x >= low - TABLE_BEYOND && x <= high + TABLE_BEYOND - TABLE_STEP);
    }
    /// Screw position minus slide position at slide position `x`, without backlash.
    double screw_error_at(double x) const;
    /// Slide position at the nut position `turned`, which follows from the revolutions of the screw.
    double slide_at(double turned) const;
};

struct AxisDesign {
    int axis = 0;  ///< geometry::Axis
    double velocity = 100, acceleration = 1000, jerk = 0;
    double low = -100, high = 100;
    double offset_ratio = 0;  ///< [AXIS_l]OFFSET_AV_RATIO; 0: no external offsets

    /// Fraction of the limits that external offsets leave for paths and stops.
    double acceleration_of_path() const { return (1 - offset_ratio) * acceleration; }
};

struct Design {
    std::string name;  ///< of the machine type, for the log
    std::string coordinates, kinematics;
    bool isTrivial = true;                       ///< joints are axes
    bool isFurther = false;                      ///< of make_further_design()
    bool isJerkLimited = false;                  ///< PLANNER_TYPE = 1
    double velocity = 100, acceleration = 1000;  ///< along the path
    double jerk = 0;
    std::vector<JointDesign> joints;
    std::vector<AxisDesign> axes;
    std::string hal_lines;
    bool hasSpindlePlant = false;  ///< false: the spindle follows a ramp exactly
    plants::SpindleTraits spindle;

    bool hasOffsets() const;
    /// Maximum time in which the acceleration rises [s]; 0: no jerk limits.
    double rise_s() const;
    /// The longest jerk filter that a linear axis or joint needs (docs/developer/planner.md, "Choice of tau")
    /// [s].
    double longest_mean_s() const;
    /// Z with the joints that move along with it: where joints are not axes all that are linear may.
    AxisDesign z_with_joints() const;
    /// Deviation of Z from the helix of a tap [rev] while the spindle reverses with `ramp`: the formula of
    /// docs/integrator/spindles.md ("Bounds"). Where joints are not axes, their curves may take half of
    /// acceleration and jerk.
    double off_helix(double lead, double ramp) const;
    /// Ramp that motion may assume for the spindle, whose drive has delay and lag, after it has started to a
    /// speed [rev/s] and before it reverses [rev/s^2].
    double gentlest_ramp(double turns_s) const;
    /// Writes campaign.ini and campaign.hal; returns the path of the INI file.
    std::string write(const std::filesystem::path &folder) const;
};

Design make_design(plants::Random &random);
/// A machine with a kinematics module that plan 1 does not use.
Design make_other_design(plants::Random &random);
/// A machine with a kinematics module that plans before 4 do not use.
Design make_further_design(plants::Random &random);
/// Adds backlash and screw errors with their INI settings.
void wear(plants::Random &random, Design &design);
/// Adds external offsets to axes of machines with trivial kinematics and without screw errors.
void allow_offsets(plants::Random &random, Design &design);
/// Adds a spindle with a drive and an encoder.
void equip_spindle(plants::Random &random, Design &design);
/// Shortens the travel and speeds up homing, so that a session has time for more acts.
void shorten(plants::Random &random, Design &design);

}  // namespace mw::campaign
