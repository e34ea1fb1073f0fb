// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/ini_keys.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/text.hh"
#include "gcode/interpreter/ini_keys.hh"

namespace mw::machine {
namespace {

using ini::IniEffect;
using ini::IniKey;
using ini::IniKind;

constexpr std::string_view OF_SCREENS =
    "ANGULAR_INCREMENTS ARCDIVISION BACK_TOOL_LATHE BALLOON_HELP CONE_BASESIZE CONFIRM_EXIT CYCLE_TIME "
    "DEFAULT_ANGULAR_VELOCITY DEFAULT_LINEAR_JOG_VEL DEFAULT_LINEAR_VELOCITY DEFAULT_SPINDLE_SPEED "
    "DISABLE_CONE_SCALING DRO_FORMAT_IN DRO_FORMAT_MM EDITOR EMBED_TAB_COMMAND EMBED_TAB_LOCATION "
    "EMBED_TAB_NAME FOAM FOAM_W FOAM_Z GCMC_INCLUDE_PATH GEOMETRY GLADEVCP GRAPHICAL_MAX_FILE_SIZE GRIDS "
    "HELP_FILE HOMING_PROMPT ICON INCREMENTS INTRO_GRAPHIC INTRO_TIME JOG_AXES JOG_INVERT LOG_FILE "
    "MACHINE_LOG_PATH MACHINE_TYPE_HINT MACRO MAX_ANGULAR_VELOCITY MAX_LINEAR_VELOCITY MAX_RAPID_OVERRIDE "
    "MAX_SPINDLE_POWER MAX_SPINDLE_SPEED MDI_HISTORY_FILE MESSAGE_BOLDTEXT "
    "MESSAGE_DETAILS MESSAGE_ICON MESSAGE_PINNAME MESSAGE_TEXT MESSAGE_TYPE MIN_ANGULAR_VELOCITY "
    "MIN_LINEAR_VELOCITY MIN_SPINDLE_SPEED MULTIMESSAGE_ID NGCGUI NGCGUI_FONT NGCGUI_OPTIONS "
    "NGCGUI_POSTAMBLE NGCGUI_PREAMBLE NGCGUI_SUBFILE NGCGUI_SUBFILE_PATH OPEN_FILE POSITION_FEEDBACK "
    "POSITION_OFFSET PREFERENCE_FILE_PATH PREVIEW_TIMEOUT PYVCP PYVCP_POSITION SPINDLE_INCREMENT TITLE "
    "TKPKG TOOL_EDITOR TTT TTT_PREAMBLE USER_COMMAND_FILE";

/// Beginning of a key of each spindle, before its number.
constexpr std::string_view OF_SCREENS_AND_SPINDLES =
    "MIN_SPINDLE_0_SPEED MAX_SPINDLE_0_SPEED DEFAULT_SPINDLE_0_SPEED MIN_SPINDLE_0_OVERRIDE "
    "MAX_SPINDLE_0_OVERRIDE DEFAULT_SPINDLE_0_OVERRIDE MIN_SPINDLE_1_SPEED MAX_SPINDLE_1_SPEED "
    "DEFAULT_SPINDLE_1_SPEED MIN_SPINDLE_1_OVERRIDE MAX_SPINDLE_1_OVERRIDE DEFAULT_SPINDLE_1_OVERRIDE "
    "MIN_SPINDLE_2_SPEED MAX_SPINDLE_2_SPEED DEFAULT_SPINDLE_2_SPEED MIN_SPINDLE_2_OVERRIDE "
    "MAX_SPINDLE_2_OVERRIDE DEFAULT_SPINDLE_2_OVERRIDE MIN_SPINDLE_3_SPEED MAX_SPINDLE_3_SPEED "
    "DEFAULT_SPINDLE_3_SPEED MIN_SPINDLE_3_OVERRIDE MAX_SPINDLE_3_OVERRIDE DEFAULT_SPINDLE_3_OVERRIDE "
    "MIN_SPINDLE_4_SPEED MAX_SPINDLE_4_SPEED DEFAULT_SPINDLE_4_SPEED MIN_SPINDLE_4_OVERRIDE "
    "MAX_SPINDLE_4_OVERRIDE DEFAULT_SPINDLE_4_OVERRIDE MIN_SPINDLE_5_SPEED MAX_SPINDLE_5_SPEED "
    "DEFAULT_SPINDLE_5_SPEED MIN_SPINDLE_5_OVERRIDE MAX_SPINDLE_5_OVERRIDE DEFAULT_SPINDLE_5_OVERRIDE "
    "MIN_SPINDLE_6_SPEED MAX_SPINDLE_6_SPEED DEFAULT_SPINDLE_6_SPEED MIN_SPINDLE_6_OVERRIDE "
    "MAX_SPINDLE_6_OVERRIDE DEFAULT_SPINDLE_6_OVERRIDE MIN_SPINDLE_7_SPEED MAX_SPINDLE_7_SPEED "
    "DEFAULT_SPINDLE_7_SPEED MIN_SPINDLE_7_OVERRIDE MAX_SPINDLE_7_OVERRIDE DEFAULT_SPINDLE_7_OVERRIDE";

constexpr std::string_view OF_HAL_FILES =
    "UNITS INPUT_SCALE OUTPUT_SCALE ENCODER_SCALE SCALE P I D FF0 FF1 FF2 BIAS DEADBAND MAX_OUTPUT "
    "OUTPUT_OFFSET DIRSETUP DIRHOLD STEPLEN STEPSPACE STEPGEN_MAXVEL STEPGEN_MAXACCEL";

std::string_view unit_of(motion::ParameterUnit unit) {
    switch (unit) {
    case motion::ParameterUnit::LENGTH: return "units";
    case motion::ParameterUnit::SPEED: return "units/s";
    case motion::ParameterUnit::ACCELERATION: return "units/s2";
    case motion::ParameterUnit::JERK: return "units/s3";
    case motion::ParameterUnit::SECONDS: return "s";
    case motion::ParameterUnit::RPM: return "rev/min";
    case motion::ParameterUnit::NONE:
    case motion::ParameterUnit::FLAG:
    case motion::ParameterUnit::COUNT: break;
    }
    return {};
}

IniKind kind_of(motion::ParameterUnit unit) {
    switch (unit) {
    case motion::ParameterUnit::FLAG: return IniKind::FLAG;
    case motion::ParameterUnit::COUNT: return IniKind::WHOLE;
    case motion::ParameterUnit::NONE:
    case motion::ParameterUnit::LENGTH:
    case motion::ParameterUnit::SPEED:
    case motion::ParameterUnit::ACCELERATION:
    case motion::ParameterUnit::JERK:
    case motion::ParameterUnit::SECONDS:
    case motion::ParameterUnit::RPM: break;
    }
    return IniKind::NUMBER;
}

/// Adds the names in a constant text, to which the returned views refer.
void add_names(std::vector<IniKey> &keys, std::string_view section, std::string_view names,
               std::string_view doc) {
    for (std::size_t begin = 0; begin < names.size();) {
        const std::size_t end = std::min(names.find(' ', begin), names.size());
        keys.push_back(ini::ini_elsewhere(section, names.substr(begin, end - begin), doc));
        begin = end + 1;
    }
}

std::string kind_text(const IniKey &key) {
    switch (key.kind) {
    case IniKind::TEXT: return "text";
    case IniKind::LIST: return "text, may be given several times";
    case IniKind::FLAG: return "yes or no";
    case IniKind::CHOICE: return fmt::format("one of {}", fmt::join(split_words(key.words), ", "));
    case IniKind::NUMBER:
    case IniKind::WHOLE: break;
    }
    std::string text = key.kind == IniKind::WHOLE ? "whole number" : "number";
    if (!key.unit.empty()) {
        text += fmt::format(" [{}]", key.unit);
    }
    const bool has_lowest = key.lowest > -ini::INI_UNBOUNDED;
    const bool has_highest = key.highest < ini::INI_UNBOUNDED;
    if (has_lowest && has_highest) {
        text += fmt::format(", {} to {}", to_text(key.lowest), to_text(key.highest));
    } else if (has_lowest) {
        text += fmt::format(", at least {}", to_text(key.lowest));
    }
    return text;
}

std::string preset_text(const IniKey &key) {
    constexpr double NO_LIMIT = 1e9;  // LinuxCNC's value for "no limit"
    if (key.required) {
        return "required";
    }
    switch (key.kind) {
    case IniKind::TEXT:
    case IniKind::CHOICE: return std::string(key.text);
    case IniKind::LIST: return "";
    case IniKind::FLAG: return key.preset != 0 ? "yes" : "no";
    case IniKind::NUMBER:
    case IniKind::WHOLE: break;
    }
    return std::fabs(key.preset) < NO_LIMIT ? to_text(key.preset) : "none";
}

void add_row(std::string &page, const IniKey &key) {
    switch (key.effect) {
    case IniEffect::EFFECTIVE:
        page += fmt::format("| {} | {} | {} | {} |\n", key.name, kind_text(key), preset_text(key), key.doc);
        break;
    case IniEffect::ELSEWHERE: page += fmt::format("| {} | | | for others: {} |\n", key.name, key.doc); break;
    case IniEffect::NONE:
        page += fmt::format("| {} | | | **no effect**, with a message{}: {} |\n", key.name,
                            key.words.empty()
                                ? ""
                                : fmt::format(" unless it is {}", fmt::join(split_words(key.words), " or ")),
                            key.doc);
        break;
    }
}

}  // namespace

std::vector<IniKey> ini_keys_of_others() {
    std::vector<IniKey> keys;
    add_names(keys, "DISPLAY", OF_SCREENS, "displays");
    add_names(keys, "DISPLAY", OF_SCREENS_AND_SPINDLES, "displays");
    add_names(keys, "JOINT_*", OF_HAL_FILES, "HAL files");
    return keys;
}

IniKey ini_key(motion::Parameter parameter) {
    const motion::ParameterInfo &info = motion::PARAMETERS[static_cast<std::size_t>(parameter)];
    IniKey key{.section = info.ini_section,
               .name = info.ini_key,
               .kind = kind_of(info.unit),
               .unit = unit_of(info.unit),
               .lowest = info.lowest,
               .highest = info.highest,
               .preset = info.preset,
               .doc = info.doc};
    if (parameter == motion::Parameter::JOINT_IS_ANGULAR) {
        key.kind = IniKind::CHOICE;
        key.text = "LINEAR";
        key.words = "LINEAR ANGULAR";
    }
    return key;
}

std::vector<IniKey> all_ini_keys() {
    std::vector<IniKey> keys(INI_KEYS.begin(), INI_KEYS.end());
    keys.insert(keys.end(), gcode::INI_KEYS.begin(), gcode::INI_KEYS.end());
    for (const motion::ParameterInfo &info : motion::PARAMETERS) {
        if (!info.ini_section.empty()) {
            keys.push_back(ini_key(info.parameter));
        }
    }
    const std::vector<IniKey> others = ini_keys_of_others();
    keys.insert(keys.end(), others.begin(), others.end());
    return keys;
}

std::string ini_reference(std::span<const IniKey> of_clients) {
    std::vector<IniKey> keys = all_ini_keys();
    keys.insert(keys.end(), of_clients.begin(), of_clients.end());
    std::ranges::stable_sort(keys, {}, [](const IniKey &key) { return key.section; });
    std::string page = "# Keys of INI files\n\n"
                       "This page lists the INI keys, for integrators. Generated from the declarations in "
                       "`src/machine/config/ini_keys.hh`, "
                       "`src/gcode/interpreter/ini_keys.hh`,\n"
                       "`src/motion/interface/parameters.hh` and `ini_keys.hh` of the clients. Lengths "
                       "are in the unit of the joint or "
                       "axis: "
                       "machine units\n"
                       "([TRAJ]LINEAR_UNITS), or degrees for rotary ones. A key that is neither on this page "
                       "nor in a HAL file is "
                       "reported with the nearest\n"
                       "name, with `--strict` as an error.\n";
    std::string_view section;
    for (const IniKey &key : keys) {
        if (key.section != section) {
            section = key.section;
            page += fmt::format("\n## [{}]\n\n| key | value | default | |\n|---|---|---|---|\n", section);
        }
        add_row(page, key);
    }
    return page;
}

}  // namespace mw::machine
