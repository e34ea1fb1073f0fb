// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/io_config.hh"

#include <algorithm>

#include "base/text.hh"
#include "machine/ini_keys.hh"

namespace mw::machine {

using config::IniReader, motion::Parameter;

void read_panel(IniReader &ini, MachineConfig &machine) {
    PanelConfig &panel = machine.panel;
    panel.min_spindle_override = ini.real(ini_key("DISPLAY", "MIN_SPINDLE_OVERRIDE"));
    panel.max_spindle_override = ini.real(ini_key("DISPLAY", "MAX_SPINDLE_OVERRIDE"));
    for (const config::IniEntry *entry : ini.list(ini_key("HALUI", "MDI_COMMAND"))) {
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
    machine.isRandomToolchanger = ini.boolean(ini_key("EMCIO", "RANDOM_TOOLCHANGER"));
    machine.task.sequencer.isToolChangeWithSpindleOn = machine.task.interpreter.tool_change.isSpindleLeftOn;
    const std::vector<std::string> program = split_words(ini.text(ini_key("EMCIO", "EMCIO")));
    const bool isVersion2 =
        !program.empty() && program.front() == "iov2" && ini.real(ini_key("EMCIO", "PROTOCOL_VERSION")) >= 2;
    machine.task.changer_protocol = {
        isVersion2, isVersion2 && std::ranges::find(program, "-support-start-change") != program.end()};
    machine.task.sequencer.changer_error_text = ini.text(ini_key("TASK", "IO_ERROR"));
    task::ToolChangePlace &place = machine.task.tool_change_place;
    const config::IniEntry *position = ini.find(ini_key("EMCIO", "TOOL_CHANGE_POSITION"));
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
