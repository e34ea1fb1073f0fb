// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/ini_settings.hh"

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::interp {
namespace {

constexpr std::string_view SECTION = "RS274NGC";

/// Folders of a list with colons, relative to the INI file.
void add_folders(const config::IniFile &ini, const config::IniEntry *entry, std::vector<std::string> &out) {
    if (entry == nullptr) {
        return;
    }
    std::string_view rest = entry->value;
    while (!rest.empty()) {
        const std::size_t colon = std::min(rest.find(':'), rest.size());
        if (const std::string_view one = trim(rest.substr(0, colon)); !one.empty()) {
            out.push_back(ini.resolve_path(one));
        }
        rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
}

double number_of(const config::IniFile &ini, std::string_view key, double missing, diag::Sink &sink) {
    const config::IniEntry *entry = ini.find(SECTION, key);
    if (entry == nullptr) {
        return missing;
    }
    const auto value = parse_double(entry->value);
    if (!value) {
        sink.error(fmt::format("[{}]{} needs a number, not '{}'", SECTION, key, entry->value), entry->place);
    }
    return value.value_or(missing);
}

bool flag_of(const config::IniFile &ini, std::string_view key, diag::Sink &sink, bool missing = false) {
    const config::IniEntry *entry = ini.find(SECTION, key);
    if (entry == nullptr) {
        return missing;
    }
    for (const std::string_view yes : {"1", "yes", "true", "on"}) {
        if (equals_ignoring_case(entry->value, yes)) {
            return true;
        }
    }
    for (const std::string_view no : {"0", "no", "false", "off"}) {
        if (equals_ignoring_case(entry->value, no)) {
            return false;
        }
    }
    sink.error(fmt::format("[{}]{} needs yes or no, not '{}'", SECTION, key, entry->value), entry->place);
    return false;
}

/// [PYTHON], with [EMC]DEBUG and [RS274NGC]LOG_LEVEL, which scripts can ask for.
void read_scripts(const config::IniFile &ini, Settings &out, diag::Sink &sink) {
    constexpr std::string_view PYTHON = "PYTHON";
    ScriptSettings &scripts = out.scripts;
    if (const config::IniEntry *entry = ini.find(PYTHON, "TOPLEVEL"); entry != nullptr) {
        scripts.top_level = ini.resolve_path(entry->value);
        scripts.place = entry->place;
    }
    for (const config::IniEntry *entry : ini.find_all(PYTHON, "PATH_PREPEND")) {
        scripts.path_prepend.push_back(ini.resolve_path(entry->value));
    }
    for (const config::IniEntry *entry : ini.find_all(PYTHON, "PATH_APPEND")) {
        scripts.path_append.push_back(ini.resolve_path(entry->value));
    }
    const auto whole = [&](std::string_view section, std::string_view key) {
        const config::IniEntry *entry = ini.find(section, key);
        const auto value = entry == nullptr ? std::optional<std::int64_t>(0) : parse_int(entry->value);
        if (!value) {
            sink.error(fmt::format("[{}]{} needs a whole number, not '{}'", section, key, entry->value),
                       entry->place);
        }
        return static_cast<int>(value.value_or(0));
    };
    scripts.isReloading = whole(PYTHON, "RELOAD_ON_CHANGE") != 0;
    scripts.log_level = whole(PYTHON, "LOG_LEVEL");
    constexpr int ALWAYS = 0x40000000;  // the field's scripts find this bit set
    out.debug_mask = whole("EMC", "DEBUG") | ALWAYS;
    out.logging_level = whole(SECTION, "LOG_LEVEL");
}

}  // namespace

Settings settings_from_ini(const config::IniFile &ini, diag::Sink &sink) {
    Settings out;
    out.ini_folder = ini.folder();
    add_folders(ini, ini.find("DISPLAY", "PROGRAM_PREFIX"), out.subroutine_path);
    add_folders(ini, ini.find(SECTION, "SUBROUTINE_PATH"), out.subroutine_path);
    add_folders(ini, ini.find("DISPLAY", "PROGRAM_PREFIX"), out.user_m_path);
    add_folders(ini, ini.find(SECTION, "USER_M_PATH"), out.user_m_path);
    if (const config::IniEntry *entry = ini.find(SECTION, "RS274NGC_STARTUP_CODE"); entry != nullptr) {
        out.startup_code = entry->value;
    }
    if (const config::IniEntry *entry = ini.find(SECTION, "ON_ABORT_COMMAND"); entry != nullptr) {
        out.on_abort_command = trim(entry->value);
    }
    for (const config::IniEntry *entry : ini.find_all(SECTION, "REMAP")) {
        out.remaps.emplace_back(entry->value, entry->place);
    }
    read_scripts(ini, out, sink);
    out.isG92PersistenceDisabled = flag_of(ini, "DISABLE_G92_PERSISTENCE", sink);
    out.isCoordinateSystemKept = flag_of(ini, "KEEP_COORDINATE_SYSTEM", sink);
    out.isFanucSubDisabled = flag_of(ini, "DISABLE_FANUC_STYLE_SUB", sink);
    out.isIniReadable = flag_of(ini, "INI_VARS", sink, true);
    out.isHalReadable = flag_of(ini, "HAL_PIN_VARS", sink, true);
    out.isToolOffsetRetained = flag_of(ini, "RETAIN_G43", sink);
    out.isArgumentCountNamed = flag_of(ini, "OWORD_NARGS", sink);
    out.orient_offset_deg = number_of(ini, "ORIENT_OFFSET", 0.0, sink);
    out.center_arc_radius_tolerance_inch =
        number_of(ini, "CENTER_ARC_RADIUS_TOLERANCE_INCH", out.center_arc_radius_tolerance_inch, sink);
    out.center_arc_radius_tolerance_mm =
        number_of(ini, "CENTER_ARC_RADIUS_TOLERANCE_MM", out.center_arc_radius_tolerance_mm, sink);
    out.parameter_g73_peck_clearance_mm =
        number_of(ini, "PARAMETER_G73_PECK_CLEARANCE", out.parameter_g73_peck_clearance_mm, sink);
    out.parameter_g83_peck_clearance_mm =
        number_of(ini, "PARAMETER_G83_PECK_CLEARANCE", out.parameter_g83_peck_clearance_mm, sink);
    return out;
}

std::optional<double> ini_number(const config::IniFile &ini, std::string_view section, std::string_view key) {
    const config::IniEntry *entry = ini.find(to_upper(section), to_upper(key));
    return entry == nullptr ? std::nullopt : parse_double(entry->value);
}

}  // namespace mw::interp
