// SPDX-License-Identifier: GPL-2.0-or-later
// The keys of an INI file that the interpreter and the scripts in it read.
#pragma once

#include <array>

#include "config/ini_key.hh"

namespace mw::interp {

inline constexpr auto INI_KEYS = std::to_array<config::IniKey>({
    config::ini_text("RS274NGC", "PARAMETER_FILE",
                     "file of the parameters and offsets that outlive a run; without it none does"),
    config::ini_text("RS274NGC", "RS274NGC_STARTUP_CODE", "a line that is interpreted before anything else"),
    config::ini_text("RS274NGC", "ON_ABORT_COMMAND", "a line that is interpreted after an abort"),
    config::ini_text("RS274NGC", "SUBROUTINE_PATH", "folders of subroutines, separated by colons"),
    config::ini_text("RS274NGC", "USER_M_PATH", "folders of the programs M100 to M199, separated by colons"),
    config::ini_list("RS274NGC", "REMAP", "a code or letter with what takes its place"),
    config::ini_flag("RS274NGC", "DISABLE_G92_PERSISTENCE", false, "G92 offsets do not outlive a run"),
    config::ini_flag("RS274NGC", "KEEP_COORDINATE_SYSTEM", false,
                     "the coordinate system in force stays at the end of a program"),
    config::ini_flag("RS274NGC", "DISABLE_FANUC_STYLE_SUB", false, "M98 and M99 are unknown codes"),
    config::ini_flag("RS274NGC", "INI_VARS", true, "programs may read #<_ini[section]key>"),
    config::ini_flag("RS274NGC", "HAL_PIN_VARS", true, "programs may read #<_hal[pin]>"),
    config::ini_flag("RS274NGC", "RETAIN_G43", false, "a tool change keeps the tool length offset of G43"),
    config::ini_flag("EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON", false, "M6 leaves the spindle on"),
    config::ini_flag("EMCIO", "TOOL_CHANGE_QUILL_UP", false, "M6 first raises Z to machine zero"),
    config::ini_flag("EMCIO", "TOOL_CHANGE_AT_G30", false, "M6 goes to the place of G30"),
    config::ini_flag("RS274NGC", "OWORD_NARGS", false,
                     "calls tell the number of their arguments in #<n_args>"),
    config::ini_number("RS274NGC", "ORIENT_OFFSET", "degrees", 0.0,
                       {-config::INI_UNBOUNDED, config::INI_UNBOUNDED}, "added to R of M19"),
    config::ini_number("RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_INCH", "inch", 0.00005,
                       {0.0, config::INI_UNBOUNDED},
                       "how far the radii at the start and at the end of an arc may differ under G20"),
    config::ini_number("RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_MM", "mm", 0.00127,
                       {0.0, config::INI_UNBOUNDED}, "the same under G21"),
    config::ini_number("RS274NGC", "PARAMETER_G73_PECK_CLEARANCE", "mm", 0.254, {0.0, config::INI_UNBOUNDED},
                       "way back to break the chip in G73"),
    config::ini_number("RS274NGC", "PARAMETER_G83_PECK_CLEARANCE", "mm", 0.254, {0.0, config::INI_UNBOUNDED},
                       "distance from the bottom at which G83 feeds again"),
    config::ini_whole("RS274NGC", "LOG_LEVEL", "", 0, {-2147483648.0, 4294967295.0},
                      "told to scripts; the interpreter keeps no log"),
    config::ini_without_effect("RS274NGC", "LOG_FILE", "this version keeps no log of the interpreter"),
    config::ini_without_effect("RS274NGC", "NO_DOWNCASE_OWORD", "names of O words are the same in any case"),
    config::ini_without_effect("RS274NGC", "OWORD_WARNONLY", "errors of O words end the program"),
    config::ini_without_effect("RS274NGC", "FEATURES", "each feature has a key of its own", "0"),
    config::ini_text("PYTHON", "TOPLEVEL", "the module that brings remaps and oword procedures in Python"),
    config::ini_list("PYTHON", "PATH_PREPEND", "folder put before Python's search path"),
    config::ini_list("PYTHON", "PATH_APPEND", "folder put behind Python's search path"),
    config::ini_whole("PYTHON", "RELOAD_ON_CHANGE", "", 0, {-2147483648.0, 4294967295.0},
                      "1: the module is loaded again when its file has changed"),
    config::ini_whole("PYTHON", "LOG_LEVEL", "", 0, {-2147483648.0, 4294967295.0},
                      "how much of the scripts' work is told"),
    config::ini_without_effect("PYTHON", "PYTHON_TASK",
                               "task calls no Python functions; remapped codes and O words do (TOPLEVEL)",
                               "0"),
    config::ini_whole("EMC", "DEBUG", "bits", 0, {-2147483648.0, 4294967295.0}, "told to scripts"),
    config::ini_text("DISPLAY", "PROGRAM_PREFIX",
                     "folder of programs, where subroutines are looked for first"),
    config::ini_flag("AXIS_*", "WRAPPED_ROTARY", false,
                     "A, B and C: absolute words lie within a turn and their sign is the direction"),
    config::ini_whole(
        "AXIS_*", "LOCKING_INDEXER_JOINT", "", -1, {-1, 15},
        "A, B and C: the joint that unlocks before the axis moves, alone and with G0, and locks "
        "afterwards; -1: none"),
    config::ini_flag("DISPLAY", "LATHE", false, "the machine is a lathe: pictures show Z and X"),
});

/// Does not compile for a key that is not declared above.
consteval const config::IniKey &ini_key(std::string_view section, std::string_view name) {
    return config::row_of(INI_KEYS, section, name);
}

}  // namespace mw::interp
