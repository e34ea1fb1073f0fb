// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/inert_keys.hh"

#include "base/text.hh"

namespace mw::machine {
namespace {

struct InertKey {
    const char *section;
    const char *key;
    const char *why;
    /// Words with which nothing is lost, separated by blanks.
    const char *harmless = "";
};

constexpr const char *ARCS = "corners are blended by one planner, whose tolerance G64 P gives";
constexpr const char *DISPLAYS = "displays run it, and millwright run starts none";
constexpr const char *CLIENTS = "no client is started by this version";

constexpr InertKey INERT[] = {
    {"TRAJ", "TPMOD", "the planner is part of motmod and cannot be exchanged", "tpmod"},
    {"EMCMOT", "HOMEMOD", "homing is part of motmod and cannot be exchanged", "homemod"},
    {"TRAJ", "POSITION_FILE", "joint positions are not kept over a restart: home the machine"},
    {"TRAJ", "NO_PROBE_JOG_ERROR", "a probe that trips in a jog stops nothing in this version"},
    {"TRAJ", "NO_PROBE_HOME_ERROR", "a probe that trips while homing stops nothing in this version"},
    {"TRAJ", "ARC_BLEND_ENABLE", ARCS, "1"},
    {"TRAJ", "ARC_BLEND_FALLBACK_ENABLE", ARCS, "0"},
    {"TRAJ", "ARC_BLEND_OPTIMIZATION_DEPTH", ARCS},
    {"TRAJ", "ARC_BLEND_GAP_CYCLES", ARCS},
    {"TRAJ", "ARC_BLEND_RAMP_FREQ", ARCS},
    {"TRAJ", "ARC_BLEND_KINK_RATIO", ARCS},
    {"HAL", "POSTGUI_HALFILE", DISPLAYS},
    {"HAL", "POSTGUI_HALCMD", DISPLAYS},
    {"HALUI", "MDI_COMMAND", "the pins halui.mdi-command-NN are not there in this version"},
    {"APPLICATIONS", "APP", CLIENTS},
    {"APPLICATIONS", "DELAY", CLIENTS},
    {"TASK", "TASK", "task is part of millwright run; no other program takes its place", "milltask"},
    {"TASK", "MDI_QUEUED_COMMANDS", "commands of a person are taken one after the other"},
    {"EMCIO", "EMCIO", "the I/O controller is part of millwright run", "io iov2"},
    {"RS274NGC", "LOG_FILE", "this version keeps no log of the interpreter"},
    {"RS274NGC", "NO_DOWNCASE_OWORD", "names of O words are the same in any case"},
    {"RS274NGC", "OWORD_WARNONLY", "errors of O words end the program"},
    {"RS274NGC", "FEATURES", "each feature has a key of its own", "0"},
};

bool isHarmless(const InertKey &inert, const std::string &value) {
    for (const std::string &word : split_words(inert.harmless)) {
        if (value == word) {
            return true;
        }
    }
    return false;
}

/// Keys of [DISPLAY] that displays read. None of them matters here, but one that no display knows is a typing
/// error.
constexpr const char *DISPLAY_KEYS =
    "ANGULAR_INCREMENTS ARCDIVISION BACK_TOOL_LATHE BALLOON_HELP CONE_BASESIZE CONFIRM_EXIT CYCLE_TIME "
    "DEFAULT_ANGULAR_VELOCITY DEFAULT_LINEAR_JOG_VEL DEFAULT_LINEAR_VELOCITY DEFAULT_SPINDLE_SPEED "
    "DISABLE_CONE_SCALING DRO_FORMAT_IN DRO_FORMAT_MM EDITOR EMBED_TAB_COMMAND EMBED_TAB_LOCATION "
    "EMBED_TAB_NAME FOAM FOAM_W FOAM_Z GCMC_INCLUDE_PATH GEOMETRY GLADEVCP GRAPHICAL_MAX_FILE_SIZE GRIDS "
    "HELP_FILE HOMING_PROMPT ICON INCREMENTS INTRO_GRAPHIC INTRO_TIME JOG_AXES JOG_INVERT LATHE LOG_FILE "
    "MACHINE_LOG_PATH MACRO MAX_ANGULAR_VELOCITY MAX_FEED_OVERRIDE MAX_LINEAR_VELOCITY MAX_RAPID_OVERRIDE "
    "MAX_SPINDLE_OVERRIDE MAX_SPINDLE_POWER MAX_SPINDLE_SPEED MDI_HISTORY_FILE MESSAGE_BOLDTEXT "
    "MESSAGE_DETAILS MESSAGE_ICON MESSAGE_PINNAME MESSAGE_TEXT MESSAGE_TYPE MIN_ANGULAR_VELOCITY "
    "MIN_LINEAR_VELOCITY MIN_SPINDLE_OVERRIDE MIN_SPINDLE_SPEED NGCGUI NGCGUI_FONT NGCGUI_OPTIONS "
    "NGCGUI_POSTAMBLE NGCGUI_PREAMBLE NGCGUI_SUBFILE NGCGUI_SUBFILE_PATH OPEN_FILE POSITION_FEEDBACK "
    "POSITION_OFFSET PREFERENCE_FILE_PATH PREVIEW_TIMEOUT PROGRAM_PREFIX PYVCP PYVCP_POSITION "
    "SPINDLE_INCREMENT TITLE TKPKG TOOL_EDITOR TTT TTT_PREAMBLE USER_COMMAND_FILE";

}  // namespace

void know_inert_keys(config::IniReader &reader) {
    for (const InertKey &inert : INERT) {
        const config::IniEntry *entry = reader.file().find(inert.section, inert.key);
        if (entry == nullptr || isHarmless(inert, entry->value)) {
            reader.know(inert.section, inert.key);
        } else {
            reader.know_without_effect(inert.section, inert.key, inert.why);
        }
    }
    for (const std::string &key : split_words(DISPLAY_KEYS)) {
        reader.know("DISPLAY", key);
    }
    for (int spindle = 0; spindle < 8; ++spindle) {
        const std::string number = std::to_string(spindle);
        for (const char *what : {"MIN_SPINDLE_", "MAX_SPINDLE_", "DEFAULT_SPINDLE_"}) {
            reader.know("DISPLAY", what + number + "_SPEED");
            reader.know("DISPLAY", what + number + "_OVERRIDE");
        }
    }
}

}  // namespace mw::machine
