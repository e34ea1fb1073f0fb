// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/ini_settings.hh"

#include <algorithm>
#include <cstdint>

#include "base/own_place.hh"
#include "base/text.hh"
#include "gcode/interpreter/ini_keys.hh"

namespace mw::gcode {
namespace {

/// Adds the folders of a list separated by colons, relative to the INI file.
void add_folders(ini::IniReader &ini, const ini::IniKey &key, std::vector<std::string> &out) {
    const std::string text = ini.text(key);
    std::string_view rest = text;
    while (!rest.empty()) {
        const std::size_t colon = std::min(rest.find(':'), rest.size());
        if (const std::string_view one = trim(rest.substr(0, colon)); !one.empty()) {
            out.push_back(ini.file().resolve_path(one));
        }
        rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
}

/// A signed or unsigned 32-bit number.
int bits_of(ini::IniReader &ini, const ini::IniKey &key) {
    return static_cast<int>(static_cast<std::uint32_t>(ini.integer(key)));
}

RotaryAxes read_rotary(ini::IniReader &ini) {
    RotaryAxes out;
    for (int axis = RotaryAxes::FIRST; axis <= RotaryAxes::LAST; ++axis) {
        const std::string section = std::string("AXIS_") + geometry::AXIS_LETTERS[axis];
        const int bit = axis - RotaryAxes::FIRST;
        out.wrapped |= ini.boolean(ini_key("AXIS_*", "WRAPPED_ROTARY"), section) ? 1U << bit : 0U;
        out.indexer[static_cast<std::size_t>(bit)] =
            static_cast<std::int8_t>(ini.integer(ini_key("AXIS_*", "LOCKING_INDEXER_JOINT"), section));
    }
    return out;
}

/// Reads [PYTHON], and [EMC]DEBUG and [RS274NGC]LOG_LEVEL, which scripts can read.
void read_scripts(ini::IniReader &ini, Settings &out) {
    ScriptSettings &scripts = out.scripts;
    const ini::IniKey &top_level = ini_key("PYTHON", "TOPLEVEL");
    if (const ini::IniEntry *entry = ini.find(top_level); entry != nullptr) {
        scripts.top_level = ini.file().resolve_path(ini.text(top_level));
        scripts.place = entry->place;
    }
    scripts.lines_run = !scripts.top_level.empty();
    for (const ini::IniEntry *entry : ini.list(ini_key("PYTHON", "PATH_PREPEND"))) {
        scripts.path_prepend.push_back(ini.file().resolve_path(entry->value));
    }
    for (const ini::IniEntry *entry : ini.list(ini_key("PYTHON", "PATH_APPEND"))) {
        scripts.path_append.push_back(ini.file().resolve_path(entry->value));
    }
    scripts.reloading = ini.integer(ini_key("PYTHON", "RELOAD_ON_CHANGE")) != 0;
    scripts.log_level = bits_of(ini, ini_key("PYTHON", "LOG_LEVEL"));
    constexpr int ALWAYS = 0x40000000;  // scripts for LinuxCNC expect this bit
    out.debug_mask = bits_of(ini, ini_key("EMC", "DEBUG")) | ALWAYS;
    out.logging_level = bits_of(ini, ini_key("RS274NGC", "LOG_LEVEL"));
}

}  // namespace

Settings settings_from_ini(ini::IniReader &ini) {
    Settings out;
    out.ini_folder = ini.file().folder();
    const ini::IniKey &prefix = ini_key("DISPLAY", "PROGRAM_PREFIX");
    out.subroutine_path.push_back(out.ini_folder);
    add_folders(ini, prefix, out.subroutine_path);
    add_folders(ini, ini_key("RS274NGC", "SUBROUTINE_PATH"), out.subroutine_path);
    // Millwright's probing programs, in the build folder or installed; the user's folders are searched first.
    out.subroutine_path.push_back(program_folder() + "/../share/probing");
    out.subroutine_path.push_back(program_folder() + "/../share/millwright/nc_files/probing");
    add_folders(ini, prefix, out.user_m_path);
    add_folders(ini, ini_key("RS274NGC", "USER_M_PATH"), out.user_m_path);
    out.startup_code = ini.text(ini_key("RS274NGC", "RS274NGC_STARTUP_CODE"));
    out.on_abort_command = trim(ini.text(ini_key("RS274NGC", "ON_ABORT_COMMAND")));
    for (const ini::IniEntry *entry : ini.list(ini_key("RS274NGC", "REMAP"))) {
        out.remaps.emplace_back(entry->value, entry->place);
    }
    read_scripts(ini, out);
    out.g92_persistence_disabled = ini.boolean(ini_key("RS274NGC", "DISABLE_G92_PERSISTENCE"));
    out.coordinate_system_kept = ini.boolean(ini_key("RS274NGC", "KEEP_COORDINATE_SYSTEM"));
    out.fanuc_sub_disabled = ini.boolean(ini_key("RS274NGC", "DISABLE_FANUC_STYLE_SUB"));
    out.ini_readable = ini.boolean(ini_key("RS274NGC", "INI_VARS"));
    out.hal_readable = ini.boolean(ini_key("RS274NGC", "HAL_PIN_VARS"));
    out.tool_offset_retained = ini.boolean(ini_key("RS274NGC", "RETAIN_G43"));
    out.tool_change.spindle_left_on = ini.boolean(ini_key("EMCIO", "TOOL_CHANGE_WITH_SPINDLE_ON"));
    out.tool_change.quill_raised = ini.boolean(ini_key("EMCIO", "TOOL_CHANGE_QUILL_UP"));
    out.tool_change.at_g30 = ini.boolean(ini_key("EMCIO", "TOOL_CHANGE_AT_G30"));
    out.argument_count_named = ini.boolean(ini_key("RS274NGC", "OWORD_NARGS"));
    out.is_lathe = ini.boolean(ini_key("DISPLAY", "LATHE"));
    out.rotary = read_rotary(ini);
    out.orient_offset_deg = ini.real(ini_key("RS274NGC", "ORIENT_OFFSET"));
    out.center_arc_tolerance.inch = ini.real(ini_key("RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_INCH"));
    out.center_arc_tolerance.mm = ini.real(ini_key("RS274NGC", "CENTER_ARC_RADIUS_TOLERANCE_MM"));
    out.parameter_g73_peck_clearance_mm = ini.real(ini_key("RS274NGC", "PARAMETER_G73_PECK_CLEARANCE"));
    out.parameter_g83_peck_clearance_mm = ini.real(ini_key("RS274NGC", "PARAMETER_G83_PECK_CLEARANCE"));
    return out;
}

std::optional<double> ini_number(const ini::IniFile &ini, std::string_view section, std::string_view key) {
    const ini::IniEntry *entry = ini.find(to_upper(section), to_upper(key));
    return entry == nullptr ? std::nullopt : parse_double(entry->value);
}

}  // namespace mw::gcode
