// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/assembly/ini_facts.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "base/ini/ini_value.hh"
#include "base/text.hh"
#include "clients/screen/facts/tabs.hh"
#include "clients/screen/files/filter.hh"
#include "machine/certificate/motion_certificate.hh"

namespace mw::screen {
namespace {

constexpr double MM_PER_INCH = 25.4;

/// Whether a key may be 0.
enum class Least : std::uint8_t { ABOVE_0, FROM_0 };

/// A number of the INI file above 0, or at least 0; a warning if it is not valid.
std::optional<double> number(const ini::IniFile &ini, const char *section, const char *key,
                             diagnostics::Sink &sink, Least least = Least::ABOVE_0) {
    const ini::IniEntry *entry = ini.find(section, key);
    if (entry == nullptr) {
        return std::nullopt;
    }
    const auto value = parse_double(entry->value);
    const bool zero = value.has_value() && *value == 0 && least == Least::FROM_0;
    if (!value.has_value() || !std::isfinite(*value) || (*value <= 0 && !zero)) {
        sink.warning("[" + entry->section + "]" + entry->key + " is '" + entry->value +
                         "', which is not a number above 0: the screen ignores the value",
                     entry->place);
        return std::nullopt;
    }
    return value;
}

struct Key {
    const char *section, *key;
};

std::optional<double> first_of(const ini::IniFile &ini, std::initializer_list<Key> keys,
                               diagnostics::Sink &sink, Least least = Least::ABOVE_0) {
    for (const Key &key : keys) {
        if (const auto value = number(ini, key.section, key.key, sink, least)) {
            return value;
        }
    }
    return std::nullopt;
}

/// Parses "1/8" or ".5".
std::optional<double> parse_fraction(std::string_view text) {
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos) {
        return parse_double(text);
    }
    const auto above = parse_double(text.substr(0, slash)), below = parse_double(text.substr(slash + 1));
    const bool whole = above.has_value() && below.has_value() && *below != 0;
    return whole ? std::optional(*above / *below) : std::nullopt;
}

std::optional<Increment> parse_increment(std::string_view text, double unit_mm) {
    constexpr std::array<std::pair<std::string_view, double>, 7> UNITS_MM{{{"mm", 1},
                                                                           {"cm", 10},
                                                                           {"um", 0.001},
                                                                           {"in", MM_PER_INCH},
                                                                           {"inch", MM_PER_INCH},
                                                                           {"mil", MM_PER_INCH / 1000},
                                                                           {"mils", MM_PER_INCH / 1000}}};
    text = trim(text);
    const std::size_t digits = std::min(text.find_first_not_of("0123456789./+-"), text.size());
    const auto value = parse_fraction(trim(text.substr(0, digits)));
    const std::string unit = to_lower(trim(text.substr(digits)));
    if (!value.has_value() || *value <= 0) {
        return std::nullopt;
    }
    if (unit == "deg" || unit == "degree" || unit == "degrees") {
        return Increment{std::string(text), *value, true};
    }
    const auto found = std::ranges::find(UNITS_MM, unit, &std::pair<std::string_view, double>::first);
    if (!unit.empty() && found == UNITS_MM.end()) {
        return std::nullopt;
    }
    return Increment{std::string(text), unit.empty() ? *value : *value * found->second / unit_mm, false};
}

std::vector<std::string> split_list(std::string_view text) {
    if (text.find(',') == std::string_view::npos) {
        return split_words(text);
    }
    std::vector<std::string> parts;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find(','), text.size());
        if (const auto part = trim(text.substr(0, end)); !part.empty()) {
            parts.emplace_back(part);
        }
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return parts;
}

std::vector<Increment> increments_of(const machine::LoadedConfig &loaded, bool has_rotary,
                                     diagnostics::Sink &sink) {
    const double unit_mm = loaded.machine.metric ? 1 : MM_PER_INCH;
    std::vector<std::string> bad;
    const ini::IniEntry *linear = loaded.ini.find("DISPLAY", "INCREMENTS");
    const char *const presets =
        loaded.machine.metric ? "10 mm, 1 mm, 0.1 mm, 0.01 mm" : "1 in, 0.1 in, 0.01 in, 0.001 in";
    std::vector<Increment> all = parse_increments(linear != nullptr ? linear->value : presets, unit_mm, bad);
    const ini::IniEntry *angular = loaded.ini.find("DISPLAY", "ANGULAR_INCREMENTS");
    if (has_rotary) {
        for (Increment one :
             parse_increments(angular != nullptr ? angular->value : "90, 10, 1, 0.1", 1, bad)) {
            one.isAngular = true;
            all.push_back(std::move(one));
        }
    }
    for (const std::string &one : bad) {
        sink.warning("[DISPLAY]INCREMENTS: '" + one + "' is not a valid jog increment",
                     linear != nullptr ? linear->place : SourcePlace{});
    }
    return all;
}

std::string program_folder(const machine::LoadedConfig &loaded) {
    const ini::IniEntry *entry = loaded.ini.find("DISPLAY", "PROGRAM_PREFIX");
    const std::string named = entry == nullptr ? "." : entry->value.substr(0, entry->value.find(':'));
    const std::string folder = loaded.ini.resolve_path(named);
    std::error_code error;
    const auto whole = std::filesystem::weakly_canonical(folder, error);
    return error ? folder : whole.string();
}

/// Extensions of programs, and of files that [FILTER] converts.
std::vector<std::string> extensions_of(const ini::IniFile &ini) {
    std::vector<std::string> all{".ngc", ".nc", ".tap", ".cnc", ".gcode"};
    for (const ini::IniEntry *entry : ini.find_all("FILTER", "PROGRAM_EXTENSION")) {
        std::string list = entry->value;
        std::ranges::replace(list, ',', ' ');
        for (const std::string &word : split_words(list)) {
            if (!word.starts_with('.') || word.size() == 1) {
                break;  // the rest is the description
            }
            if (std::ranges::find(all, to_lower(word)) == all.end()) {
                all.push_back(to_lower(word));
            }
        }
    }
    return all;
}

/// Maximum speed of all axes of a type.
std::optional<double> fastest_axis(const machine::LoadedConfig &loaded, bool is_angular,
                                   diagnostics::Sink &sink) {
    std::optional<double> most;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const std::string section = std::string("AXIS_") + geometry::AXIS_LETTERS[axis];
        if ((loaded.machine.axis_mask >> axis & 1U) != 0 && geometry::isAngular(axis) == is_angular) {
            most = std::max(most, number(loaded.ini, section.c_str(), "MAX_VELOCITY", sink));
        }
    }
    return most;
}

/// Speeds of jogs [units/s].
struct JogSpeeds {
    double highest = 1, preset = 1;
};

/// Speeds from [DISPLAY], else from [TRAJ]. Jogs are limited to the maximum speed of axes of their type.
JogSpeeds jog_speeds(const machine::LoadedConfig &loaded, bool is_angular, diagnostics::Sink &sink) {
    const ini::IniFile &ini = loaded.ini;
    const char *const highest_key = is_angular ? "MAX_ANGULAR_VELOCITY" : "MAX_LINEAR_VELOCITY";
    const char *const preset_key = is_angular ? "DEFAULT_ANGULAR_VELOCITY" : "DEFAULT_LINEAR_VELOCITY";
    constexpr double PRESET_SHARE = 0.25;
    const auto fastest = fastest_axis(loaded, is_angular, sink);
    const auto set = first_of(ini, {{"DISPLAY", highest_key}, {"TRAJ", highest_key}}, sink);
    JogSpeeds speeds;
    speeds.highest = std::min(set.value_or(fastest.value_or(1)), fastest.value_or(set.value_or(1)));
    const auto preset = first_of(ini, {{"DISPLAY", preset_key}, {"TRAJ", preset_key}}, sink);
    speeds.preset = std::min(preset.value_or(speeds.highest * PRESET_SHARE), speeds.highest);
    if (preset.has_value() && *preset > speeds.highest) {
        const ini::IniEntry *entry = ini.find("DISPLAY", preset_key);
        entry = entry != nullptr ? entry : ini.find("TRAJ", preset_key);
        sink.warning("[" + entry->section + "]" + entry->key + " = " + to_text(*preset) +
                         " exceeds the maximum jog speed of " + to_text(speeds.highest) +
                         " units/s: jogs start with the maximum",
                     entry->place, "speeds in the INI file are per second");
    }
    return speeds;
}

/// [DISPLAY] keys with the number of the spindle take precedence over those without.
SpindleFacts spindle_facts(const machine::LoadedConfig &loaded, int spindle, diagnostics::Sink &sink) {
    const std::string number = std::to_string(spindle), section = "SPINDLE_" + number;
    const auto value = [&](const std::string &first, const std::string &last) -> std::optional<double> {
        const std::string own = first + "_SPINDLE_" + number + '_' + last, all = first + "_SPINDLE_" + last;
        return first_of(loaded.ini, {{"DISPLAY", own.c_str()}, {"DISPLAY", all.c_str()}}, sink,
                        Least::FROM_0);
    };
    SpindleFacts facts;
    facts.min_override = value("MIN", "OVERRIDE").value_or(loaded.machine.panel.min_spindle_override);
    facts.max_override = value("MAX", "OVERRIDE").value_or(loaded.machine.panel.max_spindle_override);
    facts.min_speed = value("MIN", "SPEED").value_or(0);
    facts.max_speed = value("MAX", "SPEED").value_or(0);
    facts.default_speed = value("DEFAULT", "SPEED").value_or(0);
    facts.increment =
        first_of(loaded.ini, {{"DISPLAY", "SPINDLE_INCREMENT"}, {section.c_str(), "INCREMENT"}}, sink)
            .value_or(facts.increment);
    const SourcePlace place{loaded.ini.path(), 0, 0};
    if (facts.min_override > facts.max_override) {
        sink.warning("the override of spindle " + number + " has a minimum above its maximum", place);
    }
    if (facts.max_speed > 0 && facts.min_speed > facts.max_speed) {
        sink.warning("the speed of spindle " + number + " has a minimum above its maximum", place);
    }
    return facts;
}

std::string text_of(const ini::IniFile &ini, const char *section, const char *key) {
    const ini::IniEntry *entry = ini.find(section, key);
    return entry == nullptr ? std::string() : entry->value;
}

bool isYes(const ini::IniFile &ini, const char *key) {
    return ini::ini_bool(text_of(ini, "DISPLAY", key)).value_or(false);
}

/// [DISPLAY]LATHE, BACK_TOOL_LATHE and FOAM, or the same word as MACHINE_TYPE_HINT.
MachineKind kind_of(const ini::IniFile &ini, diagnostics::Sink &sink) {
    const ini::IniEntry *hint = ini.find("DISPLAY", "MACHINE_TYPE_HINT");
    const std::string word = hint == nullptr ? "" : to_lower(trim(hint->value));
    if (isYes(ini, "BACK_TOOL_LATHE") || word == "back_tool_lathe") {
        return MachineKind::BACK_LATHE;
    }
    if (isYes(ini, "LATHE") || word == "lathe") {
        return MachineKind::LATHE;
    }
    if (isYes(ini, "FOAM") || word == "foam") {
        return MachineKind::FOAM;
    }
    if (hint != nullptr && word != "mill") {
        sink.warning("[DISPLAY]MACHINE_TYPE_HINT is '" + hint->value +
                         "', not MILL, LATHE, BACK_TOOL_LATHE or FOAM: the screen shows a mill",
                     hint->place);
    }
    return MachineKind::MILL;
}

std::string geometry_of(const ini::IniFile &ini, const std::string &axes, diagnostics::Sink &sink) {
    const ini::IniEntry *entry = ini.find("DISPLAY", "GEOMETRY");
    const std::string preset(PathGeometry::PRESET);
    if (entry == nullptr || trim(entry->value).empty()) {
        return preset;
    }
    const auto parsed = PathGeometry::parse(entry->value, axes);
    if (!parsed.has_value()) {
        sink.warning("[DISPLAY]" + parsed.error().message + ": paths are drawn as by " + preset,
                     entry->place);
    }
    return parsed.has_value() ? entry->value : preset;
}

/// Height at which a plane of a foam cutter is drawn.
double foam_height(const ini::IniFile &ini, const char *key, double preset, diagnostics::Sink &sink) {
    const ini::IniEntry *entry = ini.find("DISPLAY", key);
    const auto value = entry == nullptr ? std::optional(preset) : parse_double(entry->value);
    if (!value.has_value()) {
        sink.warning("[DISPLAY]" + entry->key + " is '" + entry->value + "', which is not a number",
                     entry->place);
    }
    return value.value_or(preset);
}

ScreenFiles files_of(const ini::IniFile &ini) {
    const auto path = [&ini](const char *key) {
        constexpr std::string_view FOLDER = "WORKINGFOLDER/";  // LinuxCNC's name
        const std::string named = text_of(ini, "DISPLAY", key);
        const bool here = named.starts_with(FOLDER);
        return named.empty() ? named : ini.resolve_path(here ? named.substr(FOLDER.size()) : named);
    };
    const std::string parameters = text_of(ini, "RS274NGC", "PARAMETER_FILE");
    return {path("ICON"), path("MDI_HISTORY_FILE"), path("PREFERENCE_FILE_PATH"),
            ini.resolve_path(parameters.empty() ? "rs274ngc.var" : parameters), path("LOG_FILE")};
}

}  // namespace

std::vector<Increment> parse_increments(std::string_view text, double unit_mm,
                                        std::vector<std::string> &bad) {
    std::vector<Increment> all;
    for (const std::string &one : split_list(text)) {
        if (auto increment = parse_increment(one, unit_mm)) {
            all.push_back(std::move(*increment));
        } else if (!equals_ignoring_case(one, "continuous")) {  // every screen offers it
            bad.push_back(one);
        }
    }
    return all;
}

double status_period_s(const ini::IniFile &ini, diagnostics::Sink &sink) {
    constexpr double PRESET_S = 0.05, LEAST_S = 0.02, MOST_S = 0.2, MS_PER_S = 1000;
    const double given = number(ini, "DISPLAY", "CYCLE_TIME", sink).value_or(PRESET_S);
    return std::clamp(given >= 1 ? given / MS_PER_S : given, LEAST_S, MOST_S);
}

MachineFacts machine_facts(const machine::LoadedConfig &loaded, diagnostics::Sink &sink) {
    const ini::IniFile &ini = loaded.ini;
    const machine::MachineConfig &machine = loaded.machine;
    MachineFacts facts;
    facts.name = machine.name;
    facts.title = text_of(ini, "DISPLAY", "TITLE");
    facts.files = files_of(ini);
    facts.files.certificate = machine::last_certificate_file(machine);
    facts.tabs = tabs_of(ini, sink);
    bool has_rotary = false;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        if ((machine.axis_mask >> axis & 1U) != 0) {
            facts.axes += geometry::AXIS_LETTERS[axis];
            has_rotary = has_rotary || geometry::isAngular(axis);
        }
    }
    constexpr double PLANES_APART_IN = 1.5;
    facts.look.kind = kind_of(ini, sink);
    facts.look.geometry = geometry_of(ini, facts.axes, sink);
    facts.look.foam_z = foam_height(ini, "FOAM_Z", 0, sink);
    facts.look.foam_w =
        foam_height(ini, "FOAM_W", PLANES_APART_IN * (machine.metric ? MM_PER_INCH : 1), sink);
    facts.joints = machine.num_joints;
    for (int joint = 0; joint < machine.num_joints; ++joint) {
        const ini::IniEntry *kind = ini.find("JOINT_" + std::to_string(joint), "TYPE");
        const bool is_angular = kind != nullptr && equals_ignoring_case(kind->value, "ANGULAR");
        facts.joint_kinds.emplace_back(is_angular ? "ANGULAR" : "LINEAR");
    }
    facts.isHomingForced = machine.task.isHomingForced;
    facts.linear_unit = machine.metric ? "mm" : "inch";
    facts.program_prefix = program_folder(loaded);
    const JogSpeeds linear = jog_speeds(loaded, false, sink);
    facts.max_linear_velocity = linear.highest;
    facts.default_linear_velocity = linear.preset;
    const auto lowest = [&](const char *key) {
        return first_of(ini, {{"DISPLAY", key}, {"TRAJ", key}}, sink).value_or(0);
    };
    facts.min_linear_velocity = std::min(facts.max_linear_velocity, lowest("MIN_LINEAR_VELOCITY"));
    facts.min_angular_velocity = has_rotary ? lowest("MIN_ANGULAR_VELOCITY") : 0;
    if (has_rotary) {
        const JogSpeeds angular = jog_speeds(loaded, true, sink);
        facts.max_angular_velocity = angular.highest;
        facts.default_angular_velocity = angular.preset;
    }
    facts.max_feed_override = machine.panel.max_feed_override;
    for (int spindle = 0; spindle < machine.num_spindles; ++spindle) {
        facts.spindles.push_back(spindle_facts(loaded, spindle, sink));
    }
    facts.increments = increments_of(loaded, has_rotary, sink);
    for (const ini::IniEntry &entry : ini.entries()) {
        if (entry.section == "MDI_COMMAND_LIST" && entry.key.starts_with("MDI_COMMAND")) {
            facts.mdi_commands.push_back(entry.value);
        }
    }
    facts.program_extensions = extensions_of(ini);
    for (const auto &[extension, command] : filters_of(ini)) {
        facts.filters.extensions.push_back(extension);
    }
    return facts;
}

PathLook path_look(const MachineFacts &facts) {
    PathLook look;
    if (const auto geometry = PathGeometry::parse(facts.look.geometry, facts.axes)) {
        look.geometry = *geometry;
    }
    if (facts.look.kind == MachineKind::FOAM) {
        look.foam = {facts.look.foam_z, facts.look.foam_w};
    }
    return look;
}

}  // namespace mw::screen
