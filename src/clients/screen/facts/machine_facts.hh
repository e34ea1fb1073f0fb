// SPDX-License-Identifier: GPL-2.0-or-later
// Data about the machine that a screen needs before its status.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mw::screen {

/// A distance that a jog button offers.
struct Increment {
    std::string text;  ///< text on the button, "0.1 in"
    double value = 0;  ///< [machine units or degrees]
    bool isAngular = false;
};

/// A tab that [DISPLAY]EMBED_TAB_... adds to the screen.
struct Tab {
    enum class Kind : std::uint8_t {
        FRAME,   ///< a page of another server
        PANEL,   ///< lamps, values and buttons bound to HAL
        PROGRAM  ///< a program with a separate window
    };
    std::string name, location;
    Kind kind = Kind::PROGRAM;
    std::string content;  ///< address, JSON of the panel, or command
};

/// Paths of small files that screens read and write; empty: none.
struct ScreenFiles {
    std::string icon;  ///< a picture
    /// Lines of MDI, and preferences of operators; without a file each browser stores its own.
    std::string mdi_history, preferences;
    std::string parameters;     ///< parameter file of the interpreter
    std::string log;            ///< messages to operators
    std::string certificate{};  ///< certificate of motion of the last program
};

/// View of a machine.
enum class MachineKind : std::uint8_t {
    MILL,
    LATHE,       ///< Z to the right, tool in front of the part: X downwards
    BACK_LATHE,  ///< tool behind the part: X upwards
    FOAM         ///< foam cutter: a wire through two planes
};

/// Files that a program of [FILTER] converts to programs.
struct FilterFacts {
    std::vector<std::string> extensions;  ///< with their dot, in lower case
    std::string folder;                   ///< folder of the converted programs, named as their file with
                                          ///< ".ngc"
};

struct MachineLook {
    MachineKind kind = MachineKind::MILL;
    std::string geometry;           ///< as for PathGeometry
    double foam_z = 0, foam_w = 0;  ///< heights of the planes of a foam cutter [machine units]
};

/// Settings of a spindle that an operator may change.
struct SpindleFacts {
    double min_override = 0, max_override = 1;  ///< 1.0 is 100 %
    double min_speed = 0, max_speed = 0;        ///< [rev/min]; maximum 0: not set
    double default_speed = 0;                   ///< proposed by a screen [rev/min]; 0: not set
    double increment = 100;                     ///< step up or down [rev/min]
};

/// Lengths in machine units, angles in degrees, speeds in those per second.
struct MachineFacts {
    std::string name, ini, instance;
    std::string title;  ///< title of the page
    std::string axes;   ///< "XYZA"
    MachineLook look;
    int joints = 0;
    std::vector<std::string> joint_kinds;  ///< type of each joint, "LINEAR" or "ANGULAR"
    bool isHomingForced = true;            ///< programs and MDI require homed joints
    std::string linear_unit;               ///< "mm" or "inch"
    std::string program_prefix;            ///< folder of programs
    double max_linear_velocity = 0, default_linear_velocity = 0;
    double max_angular_velocity = 0, default_angular_velocity = 0;
    double min_linear_velocity = 0, min_angular_velocity = 0;  ///< for jogs
    double max_feed_override = 1;                              ///< 1.0 is 100 %
    std::vector<SpindleFacts> spindles;                        ///< for each spindle
    std::vector<Increment> increments;
    std::vector<std::string> mdi_commands;
    ScreenFiles files;
    std::vector<Tab> tabs;
    std::vector<std::string> program_extensions;  ///< with their dot, in lower case
    FilterFacts filters;
};

}  // namespace mw::screen
