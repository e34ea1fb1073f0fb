// SPDX-License-Identifier: GPL-2.0-or-later
// What a screen has to know of the machine before its status.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mw::screen {

/// A distance that a jog button offers.
struct Increment {
    std::string text;  ///< as it is shown, "0.1 in"
    double value = 0;  ///< [machine units or degrees]
    bool isAngular = false;
};

/// What [DISPLAY]EMBED_TAB_... adds to the screen.
struct Tab {
    enum class Kind : std::uint8_t {
        FRAME,   ///< a page of another server
        PANEL,   ///< lamps, values and buttons bound to HAL
        PROGRAM  ///< has a separate window
    };
    std::string name, location;
    Kind kind = Kind::PROGRAM;
    std::string content;  ///< address, JSON of the panel, or command
};

/// Paths of small files that screens read and keep; empty: there is none.
struct ScreenFiles {
    std::string icon;  ///< a picture
    /// Lines of MDI, and how operators like their screens: without a file each browser keeps its own.
    std::string mdi_history, preferences;
    std::string parameters;     ///< of the interpreter
    std::string log;            ///< what operators have been told
    std::string certificate{};  ///< of the motion of the last program
};

/// View of a machine.
enum class MachineKind : std::uint8_t {
    MILL,
    LATHE,       ///< Z to the right, the tool in front of the part: X downwards
    BACK_LATHE,  ///< the tool behind it: X upwards
    FOAM         ///< a wire through two planes
};

/// Files that a program of [FILTER] makes programs from.
struct FilterFacts {
    std::vector<std::string> extensions;  ///< with their dot, in lower case
    std::string folder;                   ///< of the programs that are made, named as their file with ".ngc"
};

struct MachineLook {
    MachineKind kind = MachineKind::MILL;
    std::string geometry;           ///< as PathGeometry takes it
    double foam_z = 0, foam_w = 0;  ///< heights of the planes of a foam cutter [machine units]
};

/// What an operator may set of a spindle.
struct SpindleFacts {
    double min_override = 0, max_override = 1;  ///< 1.0 is 100 %
    double min_speed = 0, max_speed = 0;        ///< [rev/min]; maximum 0: none set
    double default_speed = 0;                   ///< that a screen proposes [rev/min]; 0: none set
    double increment = 100;                     ///< of one step up or down [rev/min]
};

/// Lengths in machine units, angles in degrees, speeds in those per second.
struct MachineFacts {
    std::string name, ini, instance;
    std::string title;  ///< of the page
    std::string axes;   ///< "XYZA"
    MachineLook look;
    int joints = 0;
    std::vector<std::string> joint_kinds;  ///< of each joint, "LINEAR" or "ANGULAR"
    bool isHomingForced = true;            ///< programs and MDI want homed joints
    std::string linear_unit;               ///< "mm" or "inch"
    std::string program_prefix;            ///< folder of programs
    double max_linear_velocity = 0, default_linear_velocity = 0;
    double max_angular_velocity = 0, default_angular_velocity = 0;
    double min_linear_velocity = 0, min_angular_velocity = 0;  ///< of jogs
    double max_feed_override = 1;                              ///< 1.0 is 100 %
    std::vector<SpindleFacts> spindles;                        ///< of each spindle
    std::vector<Increment> increments;
    std::vector<std::string> mdi_commands;
    ScreenFiles files;
    std::vector<Tab> tabs;
    std::vector<std::string> program_extensions;  ///< with their dot, in lower case
    FilterFacts filters;
};

}  // namespace mw::screen
