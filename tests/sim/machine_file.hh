// SPDX-License-Identifier: GPL-2.0-or-later
// Writes INI and HAL files of simulated machines for tests: any kinematics, any joints, motors that follow at
// once, with or without a spindle.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace mw::machine {

struct SimJoint {
    bool isAngular = false;
    double velocity = 200, acceleration = 1500;  ///< of the joint [units/s, units/s^2]
    double low = -1000, high = 1000;
    double jerk = 0;  ///< 0: none
    double home = 0;  ///< position after homing
};

struct SimMachine {
    std::string coordinates = "XYZ";
    std::string kinematics = "trivkins coordinates=XYZ";
    std::vector<SimJoint> joints = std::vector<SimJoint>(3);
    std::string units = "mm";
    double velocity = 200, acceleration = 1500;  ///< along the path
    std::string traj;                            ///< further lines of [TRAJ]
    bool hasSpindle = false;
    double axis_range = 0;  ///< soft limits of the axes on both sides; 0: the limits of their joints
    std::string hal_lines;  ///< at the end of the HAL file

    /// Writes sim.ini and sim.hal into `folder`; returns the path of the INI file.
    std::string write(const std::filesystem::path &folder) const {
        std::ofstream(folder / "sim.hal") << hal();
        std::ofstream(folder / "sim.tbl") << "T1 P1 D1 Z0\n";
        std::ofstream(folder / "sim.ini") << ini();
        return (folder / "sim.ini").string();
    }

  private:
    std::string hal() const {
        std::string out = "loadrt [KINS]KINEMATICS\n"
                          "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD "
                          "num_joints=[KINS]JOINTS\n"
                          "addf motion-command-handler servo-thread\naddf motion-controller servo-thread\n"
                          "net estop-loop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n"
                          "net prepared iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n"
                          "net changed iocontrol.0.tool-change => iocontrol.0.tool-changed\n";
        for (std::size_t j = 0; j < joints.size(); ++j) {
            out += fmt::format("net pos-{0} joint.{0}.motor-pos-cmd => joint.{0}.motor-pos-fb\n", j);
        }
        return out + hal_lines;
    }
    static std::string limits_of(const SimJoint &s, double low, double high) {
        return fmt::format("MAX_VELOCITY = {}\nMAX_ACCELERATION = {}\nMIN_LIMIT = {}\nMAX_LIMIT = {}\n{}",
                           s.velocity, s.acceleration, low, high,
                           s.jerk > 0 ? fmt::format("MAX_JERK = {}\n", s.jerk) : std::string());
    }
    std::string ini() const {
        std::string letters;
        for (const char c : coordinates) {
            letters += std::string(1, c) + ' ';
        }
        std::string out =
            fmt::format("[EMC]\nVERSION = 1.1\n[DISPLAY]\nMAX_FEED_OVERRIDE = 2\n"
                        "[TASK]\nCYCLE_TIME = 0.001\n[RS274NGC]\n"
                        "[EMCMOT]\nEMCMOT = motmod\nSERVO_PERIOD = 1000000\n"
                        "[EMCIO]\nTOOL_TABLE = sim.tbl\n[HAL]\nHALFILE = sim.hal\n{}"
                        "[TRAJ]\nCOORDINATES = {}\nLINEAR_UNITS = {}\nANGULAR_UNITS = degree\n"
                        "MAX_LINEAR_VELOCITY = {}\nMAX_LINEAR_ACCELERATION = {}\n{}\n"
                        "[KINS]\nKINEMATICS = {}\nJOINTS = {}\n",
                        hasSpindle ? "HALFILE = " MW_SOURCE_DIR "/configs/sim/spindle_sim.hal\n" : "",
                        letters, units, velocity, acceleration, traj, kinematics, joints.size());
        std::string seen;
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const SimJoint &s = joints[j];
            out += fmt::format("[JOINT_{0}]\nTYPE = {1}\nFERROR = 10\nMIN_FERROR = 10\nHOME = {2}\n"
                               "HOME_OFFSET = {2}\nHOME_SEQUENCE = 0\n{3}",
                               j, s.isAngular ? "ANGULAR" : "LINEAR", s.home, limits_of(s, s.low, s.high));
            const bool isNew = j < coordinates.size() && seen.find(coordinates[j]) == std::string::npos;
            if (isNew) {
                seen += coordinates[j];
                out += fmt::format("[AXIS_{}]\n{}", coordinates[j],
                                   axis_range > 0 ? limits_of(s, -axis_range, axis_range)
                                                  : limits_of(s, s.low, s.high));
            }
        }
        return out;
    }
};

}  // namespace mw::machine
