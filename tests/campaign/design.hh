// SPDX-License-Identifier: GPL-2.0-or-later
// A random machine: what its INI and HAL files say, and what its plants are like. The judge reads limits from
// here, as they are written into the files, and never from what the product makes of them.
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
    double play = 0;                                            ///< between motor and slide
    double screw_error = 0, screw_wave = 100, screw_phase = 0;  ///< a sine [units, units, rad]
    double shaft_offset = 0;  ///< of the motor's shaft where the joint is at 0
    double start = 0;         ///< where the joint stands when the machine is made
    double counts_per_unit = 1e4;
    double index_spacing = 0;
    double index_at = 0;                     ///< position of the joint at one of the marks
    double bounce_s = 0, hysteresis = 0.02;  ///< of the home switch
    double home_switch_at = 0;               ///< closed at and below this position
    plants::AxisSettings drive;

    bool isCorrected() const { return backlash > 0 || screw_type >= 0; }
    /// A table goes so far beyond the soft limits; farther out nobody knows the screw.
    static constexpr double TABLE_BEYOND = 6, TABLE_STEP = 1;
    bool isInTable(double x) const {
        return screw_type < 0 || (x >= low - TABLE_BEYOND && x <= high + TABLE_BEYOND - TABLE_STEP);
    }
    /// How much farther than the slide the screw has turned where the slide is at `x`, without play.
    double screw_error_at(double x) const;
    /// Where the slide is when the nut's place, by turns of the screw, is `turned`.
    double slide_at(double turned) const;
};

struct AxisDesign {
    int axis = 0;  ///< geometry::Axis
    double velocity = 100, acceleration = 1000, jerk = 0;
    double low = -100, high = 100;
    double offset_ratio = 0;  ///< [AXIS_l]OFFSET_AV_RATIO; 0: no external offsets

    /// What external offsets leave for paths and their stops.
    double acceleration_of_path() const { return (1 - offset_ratio) * acceleration; }
};

struct Design {
    std::string name;  ///< of the kind, for the log
    std::string coordinates, kinematics;
    bool isTrivial = true;                       ///< joints are axes
    bool isFurther = false;                      ///< of make_further_design()
    bool isJerkLimited = false;                  ///< PLANNER_TYPE = 1
    double velocity = 100, acceleration = 1000;  ///< along the path
    double jerk = 0;
    std::vector<JointDesign> joints;
    std::vector<AxisDesign> axes;
    std::string hal_lines;
    bool hasSpindlePlant = false;  ///< else one that follows a ramp exactly
    plants::SpindleTraits spindle;

    bool hasOffsets() const;
    /// What acceleration takes to rise, of the slowest [s]; 0: no jerk limits.
    double rise_s() const;
    /// The longest mean that any linear axis or joint asks for (docs/developer/planner.md, "Choice of tau")
    /// [s].
    double longest_mean_s() const;
    /// What motion may take for the ramp of its spindle, whose drive is late and lags, as it has started to a
    /// speed [turns/s] and not turned back yet [turns/s^2].
    double gentlest_ramp(double turns_s) const;
    /// Writes campaign.ini and campaign.hal; the path of the INI file.
    std::string write(const std::filesystem::path &folder) const;
};

Design make_design(plants::Random &random);
/// Of kinematics that the first plan does not have.
Design make_other_design(plants::Random &random);
/// Of kinematics that no plan before the fourth has.
Design make_further_design(plants::Random &random);
/// Play and screws that are not even, and what the INI file says about them.
void wear(plants::Random &random, Design &design);
/// Axes that HAL pins may offset; those of machines whose joints are axes and do not wear.
void allow_offsets(plants::Random &random, Design &design);
/// A spindle with a drive and an encoder.
void equip_spindle(plants::Random &random, Design &design);
/// Ways become shorter and homing quicker, so that a session has time for more.
void shorten(plants::Random &random, Design &design);

}  // namespace mw::campaign
