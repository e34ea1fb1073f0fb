// SPDX-License-Identifier: GPL-2.0-or-later
// The INI keys of the interpreter and its scripts.
#pragma once

#include <array>

#include "base/ini/ini_key.hh"

namespace mw::gcode {

inline constexpr auto INI_KEYS = std::to_array<ini::IniKey>({
    ini::ini_text("RS274NGC", "PARAMETER_FILE",
                  "file of the parameters and offsets that outlive a run; without it none does"),
    ini::ini_text("RS274NGC", "RS274NGC_STARTUP_CODE", "a line that is interpreted before anything else"),
    ini::ini_text("RS274NGC", "ON_ABORT_COMMAND", "a line that is interpreted after an abort"),
    ini::ini_text("RS274NGC", "SUBROUTINE_PATH", "folders of subroutines, separated by colons"),
    ini::ini_text("RS274NGC", "USER_M_PATH", "folders of the programs M100 to M199, separated by colons"),
    ini::ini_list("RS274NGC", "REMAP", "a code or letter with what takes its place"),
    ini::ini_flag("RS274NGC", "DISABLE_G92_PERSISTENCE", false, "G92 offsets do not outlive a run"),
    ini::ini_flag("RS274NGC", "KEEP_COORDINATE_SYSTEM", false,
                  "the active coordinate system is kept at the end of a program"),
    ini::ini_flag("RS274NGC", "DISABLE_FANUC_STYLE_SUB", false, "M98 and M99 are unknown codes"),
    ini::ini_flag("RS274NGC", "INI_VARS", true, "programs may read #<_ini[section]key>"),
    ini::ini_flag("RS274NGC", "HAL_PIN_VARS", true, "programs may read #<_hal[pin]>"),
    ini::ini_flag("RS274NGC", "RETAIN_G43", false, "a tool change keeps the tool length offset of G43"),
    ini::ini_flag("EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON", false, "M6 leaves the spindle on"),
    ini::ini_flag("EMCIO", "TOOL_CHANGE_QUILL_UP", false, "M6 first raises Z to machine zero"),
    ini::ini_flag("EMCIO", "TOOL_CHANGE_AT_G30", false, "M6 goes to the place of G30"),
    ini::ini_flag("RS274NGC", "OWORD_NARGS", false, "calls tell the number of their arguments in #<n_args>"),
    ini::ini_number("RS274NGC", "ORIENT_OFFSET", "degrees", 0.0, {-ini::INI_UNBOUNDED, ini::INI_UNBOUNDED},
                    "added to R of M19"),
    ini::ini_number("RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_INCH", "inch", 0.00005,
                    {0.0, ini::INI_UNBOUNDED},
                    "how far the radii at the start and at the end of an arc may differ under G20"),
    ini::ini_number("RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_MM", "mm", 0.00127, {0.0, ini::INI_UNBOUNDED},
                    "the same under G21"),
    ini::ini_number("RS274NGC", "PARAMETER_G73_PECK_CLEARANCE", "mm", 0.254, {0.0, ini::INI_UNBOUNDED},
                    "way back to break the chip in G73"),
    ini::ini_number("RS274NGC", "PARAMETER_G83_PECK_CLEARANCE", "mm", 0.254, {0.0, ini::INI_UNBOUNDED},
                    "distance from the bottom at which G83 feeds again"),
    ini::ini_whole("RS274NGC", "LOG_LEVEL", "", 0, {-2147483648.0, 4294967295.0},
                   "told to scripts; the interpreter keeps no log"),
    ini::ini_without_effect("RS274NGC", "LOG_FILE", "this version keeps no log of the interpreter"),
    ini::ini_without_effect("RS274NGC", "NO_DOWNCASE_OWORD", "names of O words are the same in any case"),
    ini::ini_without_effect("RS274NGC", "OWORD_WARNONLY", "errors of O words end the program"),
    ini::ini_without_effect("RS274NGC", "FEATURES", "each feature has its own key", "0"),
    ini::ini_text("PYTHON", "TOPLEVEL", "the module that brings remaps and oword procedures in Python"),
    ini::ini_list("PYTHON", "PATH_PREPEND", "folder put before Python's search path"),
    ini::ini_list("PYTHON", "PATH_APPEND", "folder put behind Python's search path"),
    ini::ini_whole("PYTHON", "RELOAD_ON_CHANGE", "", 0, {-2147483648.0, 4294967295.0},
                   "1: the module is loaded again when its file has changed"),
    ini::ini_whole("PYTHON", "LOG_LEVEL", "", 0, {-2147483648.0, 4294967295.0},
                   "level of messages about the scripts"),
    ini::ini_without_effect("PYTHON", "PYTHON_TASK",
                            "task calls no Python functions; remapped codes and O words do (TOPLEVEL)", "0"),
    ini::ini_whole("EMC", "DEBUG", "bits", 0, {-2147483648.0, 4294967295.0}, "told to scripts"),
    ini::ini_text("DISPLAY", "PROGRAM_PREFIX", "folder of programs, where subroutines are looked for first"),
    ini::ini_flag("AXIS_*", "WRAPPED_ROTARY", false,
                  "A, B and C: absolute words lie within a turn and their sign is the direction"),
    ini::ini_whole("AXIS_*", "LOCKING_INDEXER_JOINT", "", -1, {-1, 15},
                   "A, B and C: the joint that unlocks before the axis moves, alone and with G0, and locks "
                   "afterwards; -1: none"),
    ini::ini_flag("DISPLAY", "LATHE", false, "the machine is a lathe: pictures show Z and X"),
});

/// The key must be in the table above; otherwise it does not compile.
consteval const ini::IniKey &ini_key(std::string_view section, std::string_view name) {
    return ini::row_of(INI_KEYS, section, name);
}

}  // namespace mw::gcode
