// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/design.hh"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <fmt/format.h>

#include "base/geometry/pose.hh"
#include "campaign/design_parts.hh"

namespace mw::campaign {

double rounded(double x, double step) {
    return std::round(x / step) * step;
}

double power(plants::Random &random, double low, double high) {
    return rounded(std::pow(10.0, random.real(low, high)), 0.01);
}

JointDesign make_joint(plants::Random &random, bool isAngular, bool isJerkLimited) {
    JointDesign j;
    j.isAngular = isAngular;
    j.velocity = power(random, 1.3, 2.5);
    j.acceleration = power(random, 2.3, 3.7);
    const bool hasJerk = isJerkLimited && random.chance(0.85);
    j.jerk = hasJerk ? rounded(j.acceleration * std::pow(10.0, random.real(1, 2.2)), 1) : 0;
    j.low = rounded(-random.real(60, 250), 0.1);
    j.high = rounded(random.real(60, 250), 0.1);
    j.ferror = rounded(random.real(1.5, 5), 0.1);
    j.min_ferror = rounded(random.real(0.6, 1.5), 0.1);
    j.shaft_offset = rounded(random.real(-30, 30), 0.001);
    j.start = random.real(0.7 * j.low, 0.7 * j.high);
    j.counts_per_unit = random.chance(0.5) ? 1e4 : 1000;
    j.drive.coulomb_friction = random.real(0, 300);
    j.drive.viscous_friction = random.real(0, 5);
    j.drive.peak_acceleration = 20 * j.acceleration + 2000;
    return j;
}

JointDesign make_plain(plants::Random &random, bool isAngular, double reach, bool isJerkLimited) {
    JointDesign j = make_joint(random, isAngular, isJerkLimited);
    j.velocity = std::max(j.velocity, 60.0);
    j.low = -reach;
    j.high = reach;
    j.start = 0;
    return j;
}

AxisDesign axis_of(int axis, const JointDesign &j) {
    return {axis, j.velocity, j.acceleration, j.jerk, j.low, j.high};
}

namespace {

/// Distance of the limit switches outside the soft limits; home switches are at a fraction of it.
constexpr double TO_HOME_SWITCH = 1;

void make_homing(plants::Random &random, JointDesign &j) {
    j.home = rounded(random.real(0.5 * j.low, 0.5 * j.high), 0.1);
    j.home_kind = random.chance(0.4)   ? HomeKind::IMMEDIATE
                  : random.chance(0.5) ? HomeKind::SWITCH
                                       : HomeKind::SWITCH_AND_INDEX;
    if (j.home_kind == HomeKind::IMMEDIATE) {
        j.home_offset = j.home;
        return;
    }
    // Fast enough to find the switch soon, slow enough to stop within the overtravel behind it.
    constexpr double ROOM = 2.5;
    const double stoppable = 0.7 * std::sqrt(2 * ROOM * j.acceleration);
    j.search = -rounded(std::min({0.9 * j.velocity, stoppable, j.jerk > 0 ? 15.0 : 1e9}), 0.1);
    j.latch = rounded(random.real(0.8, 2), 0.1) * (random.chance(0.5) ? -1 : 1);
    j.bounce_s = random.chance(0.5) ? 0 : random.real(0.001, 0.004);
    j.home_switch_at = j.low - TO_HOME_SWITCH;
    j.home_offset = j.home_switch_at;
    if (j.home_kind == HomeKind::SWITCH_AND_INDEX) {
        // Far enough from the switch edge that the slow move always finds the same index mark.
        j.index_spacing = 5;
        j.index_at = rounded(j.home_switch_at + std::copysign(random.real(0.5, 1.5), j.latch), 0.01);
        j.home_offset = j.index_at;
    }
}

/// Joints that move the axes of the letters.
void make_trivial(plants::Random &random, Design &d, const std::string &letters) {
    d.coordinates = letters;
    d.kinematics = "trivkins coordinates=" + letters;
    const bool isSequenced = random.chance(0.5);
    for (std::size_t i = 0; i < letters.size(); ++i) {
        const int axis = geometry::axis_of_letter(letters[i]);
        const std::size_t first = letters.find(letters[i]);
        if (first != i) {
            // The second joint of a gantry.
            JointDesign twin = d.joints[first];
            twin.shaft_offset = rounded(random.real(-30, 30), 0.001);
            d.joints.push_back(twin);
            continue;
        }
        JointDesign j = make_joint(random, geometry::isAngular(axis), d.isJerkLimited);
        make_homing(random, j);
        const bool isGantry = letters.find(letters[i], i + 1) != std::string::npos;
        j.sequence = isSequenced || isGantry ? static_cast<int>(i) : 0;
        j.sequence = isGantry ? -std::max(1, j.sequence) : j.sequence;
        d.joints.push_back(j);
        d.axes.push_back(axis_of(axis, j));
    }
    // Home sequences start at 0 or 1 and have no gaps.
    bool hasFirst = false;
    for (JointDesign &j : d.joints) {
        j.sequence = !isSequenced && j.sequence > 0 ? 1 : j.sequence;
        hasFirst = hasFirst || j.sequence == 0;
    }
    if (letters == "XYYZ") {
        d.joints[0].sequence = 0;
        d.joints[1].sequence = d.joints[2].sequence = -1;
        d.joints[3].sequence = isSequenced ? 2 : 0;
    }
    for (AxisDesign &a : d.axes) {
        if (random.chance(0.3)) {
            a.velocity = rounded(a.velocity * random.real(0.3, 1), 0.01);
            a.acceleration = rounded(a.acceleration * random.real(0.3, 1), 0.01);
        }
    }
}

/// CoreXY: X and Y by two belts.
void make_corexy(plants::Random &random, Design &d) {
    d.coordinates = "XYZ";
    d.kinematics = "corexykins";
    d.isTrivial = false;
    for (int axis = 0; axis < 3; ++axis) {
        d.joints.push_back(make_plain(random, false, 400, d.isJerkLimited));
        AxisDesign a = axis_of(axis, make_joint(random, false, d.isJerkLimited));
        a.low = -120;
        a.high = 120;
        d.axes.push_back(a);
    }
}

/// A tilting rotary table (trunnion).
void make_trunnion(plants::Random &random, Design &d) {
    d.coordinates = "XYZAC";
    d.kinematics = "xyzac-trt-kins";
    d.isTrivial = false;
    for (const int axis :
         {geometry::AXIS_X, geometry::AXIS_Y, geometry::AXIS_Z, geometry::AXIS_A, geometry::AXIS_C}) {
        const bool isAngular = geometry::isAngular(axis);
        d.joints.push_back(make_plain(random, isAngular, isAngular ? 720 : 600, d.isJerkLimited));
        AxisDesign a = axis_of(axis, make_joint(random, isAngular, d.isJerkLimited));
        a.low = isAngular ? -40 : -100;
        a.high = isAngular ? 40 : 100;
        d.axes.push_back(a);
    }
    d.hal_lines = fmt::format("setp xyzac-trt-kins.tool-offset {}\nsetp xyzac-trt-kins.z-offset {}\n",
                              random.whole(0, 60), random.whole(0, 20));
}

/// A tilting head with a quill.
void make_head(plants::Random &random, Design &d) {
    d.name = "head";
    d.coordinates = "XYZBCW";
    d.kinematics = "5axiskins";
    d.isTrivial = false;
    for (const int axis : {geometry::AXIS_X, geometry::AXIS_Y, geometry::AXIS_Z, geometry::AXIS_B,
                           geometry::AXIS_C, geometry::AXIS_W}) {
        const bool isAngular = geometry::isAngular(axis);
        d.joints.push_back(make_plain(random, isAngular, isAngular ? 720 : 900, d.isJerkLimited));
        AxisDesign a = axis_of(axis, make_joint(random, isAngular, d.isJerkLimited));
        a.low = isAngular ? -40 : -60;
        a.high = isAngular ? 40 : 60;
        d.axes.push_back(a);
    }
}

/// A linear delta: three carriages on columns.
void make_delta(plants::Random &random, Design &d) {
    d.name = "delta";
    d.coordinates = "XYZ";
    d.kinematics = "lineardeltakins";
    d.isTrivial = false;
    for (int axis = 0; axis < 3; ++axis) {
        JointDesign j = make_plain(random, false, 600, d.isJerkLimited);
        j.low = 150;
        j.start = j.home = j.home_offset = 450;
        d.joints.push_back(j);
        AxisDesign a = axis_of(axis, make_joint(random, false, d.isJerkLimited));
        a.low = axis == geometry::AXIS_Z ? 80 : -50;
        a.high = axis == geometry::AXIS_Z ? 280 : 50;
        d.axes.push_back(a);
    }
}

}  // namespace

Design make_other_design(plants::Random &random) {
    Design d;
    d.isJerkLimited = random.chance(0.4);
    d.velocity = power(random, 1.6, 2.6);
    d.acceleration = power(random, 2.5, 3.8);
    random.chance(0.5) ? make_head(random, d) : make_delta(random, d);
    return d;
}

Design make_design(plants::Random &random) {
    Design d;
    d.isJerkLimited = random.chance(0.4);
    d.velocity = power(random, 1.6, 2.6);
    d.acceleration = power(random, 2.5, 3.8);
    d.jerk = d.isJerkLimited && random.chance(0.3) ? rounded(d.acceleration * random.real(10, 60), 1) : 0;
    const int kind = random.whole(0, 9);
    d.name = kind < 4   ? "XYZ"
             : kind < 5 ? "XZ"
             : kind < 6 ? "XYZA"
             : kind < 8 ? "XYYZ"
             : kind < 9 ? "corexy"
                        : "trunnion";
    if (kind < 8) {
        make_trivial(random, d, d.name);
    } else if (kind < 9) {
        make_corexy(random, d);
    } else {
        make_trunnion(random, d);
    }
    return d;
}

namespace {

void hasten_homing(plants::Random &random, JointDesign &j) {
    constexpr double ROOM = 2.5;                                             // for the stop behind the switch
    const double jerk_way = j.jerk > 0 ? 0.5 * j.acceleration / j.jerk : 0;  // for each unit/s
    // v (v / 2a + w) = ROOM
    const double w = j.acceleration * jerk_way;
    const double stoppable = std::sqrt(w * w + 2 * ROOM * j.acceleration) - w;
    j.search = -rounded(std::clamp(0.6 * stoppable, 5.0, 0.9 * j.velocity), 0.1);
    j.latch = rounded(std::copysign(random.real(2.5, 5), j.latch), 0.1);
    j.start = j.home_switch_at + random.real(3, 25);
    j.home = rounded(random.real(0.5 * j.low, 0.2 * j.high), 0.1);
}

/// The second joint of a gantry.
void make_twin(JointDesign &j, const JointDesign &first) {
    const double shaft_offset = j.shaft_offset;
    j = first;
    j.shaft_offset = shaft_offset;
}

std::size_t first_of_axis(const Design &design, std::size_t joint) {
    return design.isTrivial ? design.coordinates.find(design.coordinates[joint]) : joint;
}

}  // namespace

double JointDesign::screw_error_at(double x) const {
    return screw_error * std::sin(2 * std::numbers::pi * x / screw_wave + screw_phase);
}

double JointDesign::slide_at(double turned) const {
    double x = turned;
    constexpr int ROUNDS = 4;  // each round adds at least two exact digits
    for (int i = 0; i < ROUNDS && screw_error > 0; ++i) {
        x = turned - screw_error_at(x);
    }
    return x;
}

double Design::rise_s() const {
    double most = jerk > 0 ? acceleration / jerk : 0;
    for (const JointDesign &j : joints) {
        most = std::max(most, j.jerk > 0 ? j.acceleration / j.jerk : 0);
    }
    return isJerkLimited ? most : 0;
}

double Design::longest_mean_s() const {
    double most = 0;
    const auto look = [&](bool isAngular, double v, double a, double j) {
        const double mean = j > 0 ? std::min(a / j, std::sqrt(v / j)) : 0;
        most = isAngular ? most : std::max(most, mean);
    };
    for (const JointDesign &d : joints) {
        look(d.isAngular, d.velocity, d.acceleration, d.jerk);
    }
    for (const AxisDesign &x : axes) {
        look(geometry::isAngular(x.axis), x.velocity, x.acceleration, x.jerk);
    }
    return isJerkLimited ? most : 0;
}

void wear(plants::Random &random, Design &design) {
    const bool hasPlay = random.chance(0.3);
    const bool hasScrews = random.chance(0.3);
    for (std::size_t n = 0; n < design.joints.size(); ++n) {
        JointDesign &j = design.joints[n];
        if (const std::size_t first = first_of_axis(design, n); first != n) {
            make_twin(j, design.joints[first]);
            continue;
        }
        if (hasPlay && random.chance(0.7)) {
            j.play = j.backlash = rounded(random.real(0.03, 0.3), 0.001);
        }
        // Without a switch the position of the slide on its screw is unknown.
        if (hasScrews && j.home_kind != HomeKind::IMMEDIATE && random.chance(0.8)) {
            j.screw_error = rounded(random.real(0.02, 0.12), 0.001);
            j.screw_wave = random.real(80, 300);
            j.screw_phase = random.real(0, 6.28);
            j.screw_type = random.whole(0, 1);
            j.backlash = 0;  // the table contains the backlash
        }
        if (j.home_kind == HomeKind::SWITCH_AND_INDEX) {
            // The index mark is on the motor: BACKLASH is symmetrical to it; a table refers to the slide.
            const double lag = j.screw_type >= 0 ? std::copysign(0.5 * j.play, j.latch) : 0;
            j.home_offset = j.slide_at(j.index_at - lag);
        }
    }
}

bool Design::hasOffsets() const {
    return std::ranges::any_of(axes, [](const AxisDesign &a) { return a.offset_ratio > 0; });
}

void allow_offsets(plants::Random &random, Design &design) {
    const bool isWorn =
        std::ranges::any_of(design.joints, [](const JointDesign &j) { return j.isCorrected(); });
    if (isWorn || !design.isTrivial || !random.chance(0.4)) {
        return;
    }
    for (AxisDesign &a : design.axes) {
        a.offset_ratio = random.chance(0.6) ? rounded(random.real(0.1, 0.6), 0.01) : 0;
    }
}

void shorten(plants::Random &random, Design &design) {
    for (std::size_t n = 0; n < design.joints.size(); ++n) {
        JointDesign &j = design.joints[n];
        const std::size_t first = design.isTrivial ? design.coordinates.find(design.coordinates[n]) : n;
        if (first != n) {
            make_twin(j, design.joints[first]);
            continue;
        }
        if (!design.isTrivial) {
            continue;
        }
        const double low = j.low;
        j.low = rounded(-random.real(40, 100), 0.1);
        j.high = rounded(random.real(40, 100), 0.1);
        j.start = random.real(0.7 * j.low, 0.7 * j.high);
        j.home_switch_at += j.low - low;
        j.index_at += j.low - low;
        j.home_offset += j.low - low;
        if (j.home_kind != HomeKind::IMMEDIATE) {
            hasten_homing(random, j);
        } else {
            j.home = j.home_offset = rounded(random.real(0.5 * j.low, 0.5 * j.high), 0.1);
        }
        for (AxisDesign &a : design.axes) {
            if (a.axis == geometry::axis_of_letter(design.coordinates[n])) {
                a.low = j.low;
                a.high = j.high;
            }
        }
    }
}

namespace {

template <class Limits>
std::string limits_of(const Limits &s) {
    return fmt::format("MAX_VELOCITY = {}\nMAX_ACCELERATION = {}\nMIN_LIMIT = {}\nMAX_LIMIT = {}\n{}",
                       s.velocity, s.acceleration, s.low, s.high,
                       s.jerk > 0 ? fmt::format("MAX_JERK = {}\n", s.jerk) : std::string());
}

std::string section_of(std::size_t n, const JointDesign &j) {
    std::string out = fmt::format("[JOINT_{}]\nTYPE = {}\nFERROR = {}\nMIN_FERROR = {}\nHOME = {}\n"
                                  "HOME_OFFSET = {}\nHOME_SEQUENCE = {}\n{}",
                                  n, j.isAngular ? "ANGULAR" : "LINEAR", j.ferror, j.min_ferror, j.home,
                                  j.home_offset, j.sequence, limits_of(j));
    if (j.home_kind != HomeKind::IMMEDIATE) {
        out += fmt::format("HOME_SEARCH_VEL = {}\nHOME_LATCH_VEL = {}\n", j.search, j.latch);
    }
    if (j.home_kind == HomeKind::SWITCH_AND_INDEX) {
        out += "HOME_USE_INDEX = YES\n";
    }
    if (j.screw_type >= 0) {
        out += fmt::format("COMP_FILE = screw{}.txt\nCOMP_FILE_TYPE = {}\n", n, j.screw_type);
    }
    return out + (j.backlash > 0 ? fmt::format("BACKLASH = {}\n", j.backlash) : std::string());
}

/// Type 0: slide position at a screw position; type 1: correction to add.
void write_screw(const std::filesystem::path &file, const JointDesign &j) {
    std::ofstream out(file);
    const double half = 0.5 * j.play;
    constexpr double BEYOND = JointDesign::TABLE_BEYOND;
    for (double x = j.low - BEYOND; x < j.high + BEYOND; x += JointDesign::TABLE_STEP) {
        const double up = j.screw_error_at(x) + half;
        const double down = j.screw_error_at(x) - half;
        out << (j.screw_type == 0 ? fmt::format("{:.9f} {:.9f} {:.9f}\n", x, x - up, x - down)
                                  : fmt::format("{:.9f} {:.9f} {:.9f}\n", x, up, down));
    }
}

constexpr const char *HAL =
    "loadrt [KINS]KINEMATICS\n"
    "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS\n"
    "addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n"
    "net chain iocontrol.0.emc-enable-in\n"
    "net prepared iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n"
    "net changed iocontrol.0.tool-change => iocontrol.0.tool-changed\n";

}  // namespace

std::string Design::write(const std::filesystem::path &folder) const {
    std::ofstream(folder / "campaign.hal") << HAL << hal_lines;
    std::ofstream(folder / "campaign.tbl") << "T1 P1 D1 Z0\n";
    std::string letters;
    for (const char c : coordinates) {
        letters += std::string(1, c) + ' ';
    }
    std::string out = fmt::format(
        "[EMC]\nVERSION = 1.1\n[DISPLAY]\nMAX_FEED_OVERRIDE = 1.5\n[TASK]\nCYCLE_TIME = 0.001\n[RS274NGC]\n"
        "[EMCMOT]\nEMCMOT = motmod\nSERVO_PERIOD = 1000000\n[EMCIO]\nTOOL_TABLE = campaign.tbl\n"
        "[HAL]\nHALFILE = campaign.hal\n"
        "[TRAJ]\nCOORDINATES = {}\nLINEAR_UNITS = mm\nANGULAR_UNITS = degree\nPLANNER_TYPE = {}\n"
        "MAX_LINEAR_VELOCITY = {}\nMAX_LINEAR_ACCELERATION = {}\n{}[KINS]\nKINEMATICS = {}\nJOINTS = {}\n",
        letters, isJerkLimited ? 1 : 0, velocity, acceleration,
        jerk > 0 ? fmt::format("MAX_LINEAR_JERK = {}\n", jerk) : std::string(), kinematics, joints.size());
    for (std::size_t n = 0; n < joints.size(); ++n) {
        out += section_of(n, joints[n]);
        if (joints[n].screw_type >= 0) {
            write_screw(folder / fmt::format("screw{}.txt", n), joints[n]);
        }
    }
    for (const AxisDesign &a : axes) {
        out += fmt::format("[AXIS_{}]\n{}", geometry::AXIS_LETTERS[a.axis], limits_of(a));
        out += a.offset_ratio > 0 ? fmt::format("OFFSET_AV_RATIO = {}\n", a.offset_ratio) : std::string();
    }
    std::ofstream(folder / "campaign.ini") << out;
    return (folder / "campaign.ini").string();
}

}  // namespace mw::campaign
