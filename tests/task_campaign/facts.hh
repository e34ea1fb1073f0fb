// SPDX-License-Identifier: GPL-2.0-or-later
// The meaning of lines of G-code according to the manual, limited to the needs of a judge. Independent of the
// interpreter, task and messages.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "components/plants/random.hh"

namespace mw::task_campaign {

inline constexpr int AXES = 3, SYSTEMS = 6;
inline constexpr double MM_PER_INCH = 25.4;
/// Soft limits of all axes, on both sides. [mm]
inline constexpr double LIMIT_MM = 150;
using Place = std::array<double, AXES>;  ///< [mm]

struct Tool {
    int number = 0, pocket = 0;
    double z = 0;  ///< [mm]
    bool operator==(const Tool &) const = default;
};

/// State set by programs; after a stop it is that of the executed block.
struct Modes {
    bool isAbsolute = true, isInch = false;
    int system = 1;                        ///< G54 is 1
    std::array<Place, SYSTEMS> systems{};  ///< G5x
    Place g92{}, kept_g92{};               ///< active offset, and the offset stored in #5211 to #5219
    bool isG92On = false;
    double tool_z = 0;  ///< G43
    Place g28{}, g30{};
    double kept = 0;         ///< #3101, which is stored in the parameter file
    double feed_mm_min = 0;  ///< F
    double speed_rpm = 0;    ///< S
    bool operator==(const Modes &) const = default;
};

/// Actions of the machine; a stop keeps those that were executed.
struct Doings {
    int in_spindle = 0;
    std::vector<Tool> tools;
    bool isRandom = false;
    int direction = 0;  ///< direction of the spindle
    double turning_rpm = 0;
    bool isMist = false, isFlood = false;
    Place at{};  ///< positions of the axes
    bool operator==(const Doings &) const = default;

    double z_of(int tool) const;
    bool has(int tool) const;
    /// Puts the tool into the spindle; in a random changer the previous tool gets its pocket.
    void load(int tool);
};

struct World {
    Modes modes;
    Doings doings;
    bool operator==(const World &) const = default;
};

enum class Kind {
    RAPID,
    FEED,  // values: machine units of the program, per axis
    ABSOLUTE,
    INCREMENTAL,
    INCH,
    MM,
    SYSTEM,      // number: 1 to 6
    SET_SYSTEM,  // G10 L2, number
    TOUCH_OFF,   // G10 L20, number
    G92,
    FORGET_G92,
    SUSPEND_G92,
    RESTORE_G92,
    KEEP_G28,
    KEEP_G30,
    OFFSET,  // G43 H number; 0: the tool in the spindle
    NO_OFFSET,
    SET_TOOL,  // G10 L1 P number Z
    CHANGE,    // T number M6
    SELECT,    // T number
    CALL_IT,   // M61 Q number
    TURN,      // S number M3 or M4 by the sign
    HALT_SPINDLE,
    MIST,
    FLOOD,
    DRY,
    KEEP,  // #3101 = value
    DWELL,
    STOP,
    OPTIONAL_STOP,
    REMARK,
    WRONG,  // must end the program: text
};

struct Line {
    Kind kind = Kind::REMARK;
    std::array<std::optional<double>, AXES> values{};
    int number = 0;
    bool isSkippable = false;  ///< /
    std::string wrong;

    std::string text() const;
};

/// False when the line must end the program.
bool apply(const Line &line, World &world, bool isBlockDelete);
/// M2.
void end_program(World &world);
/// The state that remains after a crash, from the parameter file and the tool table.
World after_crash(const World &kept);

/// A line that can be executed in that state.
Line make_line(plants::Random &random, const World &world);
Line make_wrong_line(plants::Random &random);

/// "" or the first difference.
std::string difference(const Modes &expected, const Modes &seen);
std::string difference(const std::vector<Tool> &expected, const std::vector<Tool> &seen);
bool isSame(double a, double b);

}  // namespace mw::task_campaign
