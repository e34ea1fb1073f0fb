// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/io_config.hh"

#include <algorithm>

#include "base/text.hh"
#include "machine/config/ini_keys.hh"

namespace mw::machine {

using ini::IniReader, motion::Parameter;

namespace {

/// True for keys of [DISPLAY] that limit an override, for instance MAX_FEED_OVERRIDE or
/// MIN_SPINDLE_1_OVERRIDE.
bool isOverrideLimit(std::string_view key) {
    const bool is_limit = key.starts_with("MIN_") || key.starts_with("MAX_") || key.starts_with("DEFAULT_");
    return is_limit && key.ends_with("_OVERRIDE");
}

/// Checks override limits, which are ratios; a value that looks like a percentage is 100 times the intended
/// value.
void check_override_limits(IniReader &ini) {
    constexpr double MOST_PLAUSIBLE = 10, PERCENT = 100;
    for (const ini::IniEntry &entry : ini.file().entries()) {
        if (entry.section != "DISPLAY" || !isOverrideLimit(entry.key)) {
            continue;
        }
        const auto value = parse_double(entry.value);
        if (value.has_value() && *value > MOST_PLAUSIBLE) {
            ini.sink().warning("[DISPLAY]" + entry.key + " = " + entry.value + ": the override may reach " +
                                   to_text(*value * PERCENT) + " %",
                               entry.place, "1.0 is 100 %");
        }
    }
}

/// Marks the keys of messages named in MULTIMESSAGE_ID as known.
void know_messages(IniReader &ini) {
    for (const ini::IniEntry *id : ini.file().find_all("DISPLAY", "MULTIMESSAGE_ID")) {
        for (const char *part : {"NUMBER", "TYPE", "TITLE", "TEXT", "DETAILS", "ICON"}) {
            ini.know_if_ours("DISPLAY", "MULTIMESSAGE_" + std::string(trim(id->value)) + '_' + part);
        }
    }
}

}  // namespace

void read_panel(IniReader &ini, MachineConfig &machine) {
    check_override_limits(ini);
    know_messages(ini);
    PanelConfig &panel = machine.panel;
    panel.min_spindle_override = ini.real(ini_key("DISPLAY", "MIN_SPINDLE_OVERRIDE"));
    panel.max_spindle_override = ini.real(ini_key("DISPLAY", "MAX_SPINDLE_OVERRIDE"));
    for (const ini::IniEntry *entry : ini.list(ini_key("HALUI", "MDI_COMMAND"))) {
        panel.mdi_commands.push_back(entry->value);
    }
    for (const motion::SetParameter &parameter : machine.parameters) {
        if (parameter.parameter == static_cast<std::uint16_t>(Parameter::TRAJ_MAX_VELOCITY)) {
            panel.max_velocity = parameter.value;
        } else if (parameter.parameter == static_cast<std::uint16_t>(Parameter::MAX_FEED_SCALE)) {
            panel.max_feed_override = parameter.value;
        }
    }
}

void read_io(IniReader &ini, MachineConfig &machine) {
    const std::string table = ini.text(ini_key("EMCIO", "TOOL_TABLE"));
    machine.tool_table_file = table.empty() ? "" : ini.file().resolve_path(table);
    machine.tool_database = ini.text(ini_key("EMCIO", "DB_PROGRAM"));
    machine.ini_folder = ini.file().folder();
    machine.is_random_toolchanger = ini.boolean(ini_key("EMCIO", "RANDOM_TOOLCHANGER"));
    machine.task.sequencer.tool_change_with_spindle_on = machine.task.interpreter.tool_change.spindle_left_on;
    const std::vector<std::string> program = split_words(ini.text(ini_key("EMCIO", "EMCIO")));
    const bool is_version2 =
        !program.empty() && program.front() == "iov2" && ini.real(ini_key("EMCIO", "PROTOCOL_VERSION")) >= 2;
    machine.task.changer_protocol = {
        is_version2, is_version2 && std::ranges::find(program, "-support-start-change") != program.end()};
    machine.task.sequencer.changer_error_text = ini.text(ini_key("TASK", "IO_ERROR"));
    task::ToolChangePlace &place = machine.task.tool_change_place;
    const ini::IniEntry *position = ini.find(ini_key("EMCIO", "TOOL_CHANGE_POSITION"));
    if (position != nullptr) {
        const std::vector<std::string> words = split_words(position->value);
        for (std::size_t i = 0; i < words.size() && i < MAX_AXES; ++i) {
            const auto value = parse_double(words[i]);
            place.position[static_cast<int>(i)] = value.value_or(0.0);
            place.coordinates = value.has_value() ? place.coordinates + 1 : -1000;
        }
        if (words.size() != 3 && words.size() != 6 && words.size() != 9) {
            place.coordinates = -1;
        }
        if (place.coordinates < 0) {
            ini.sink().error("[EMCIO]TOOL_CHANGE_POSITION = '" + position->value + "' is malformed",
                             position->place, "expected 3, 6 or 9 numbers: X Y Z [A B C [U V W]]");
            place.coordinates = 0;
        }
    }
}

}  // namespace mw::machine
