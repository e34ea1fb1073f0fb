// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/ini_form.hh"

#include "base/limits.hh"
#include "base/text.hh"
#include "machine/config/ini_keys.hh"

namespace mw::machine {

void check_form(ini::IniReader &ini) {
    const ini::IniFile &file = ini.file();
    const std::string hint = "update_ini " + file.path() + " writes the current format";
    for (int axis = 0; axis < MAX_JOINTS; ++axis) {
        const std::string section = "AXIS_" + std::to_string(axis);
        if (file.hasSection(section)) {
            ini.sink().error("section [" + section + "] has the format before LinuxCNC 2.8",
                             file.place_of_section(section), hint);
            return;
        }
    }
    const ini::IniEntry *version = ini.find(ini_key("EMC", "VERSION"));
    const std::string text(version != nullptr ? trim(version->value) : std::string_view());
    if (!text.empty() && text != "1.1" && text != "$Revision$") {
        ini.sink().warning("[EMC]VERSION = " + text + " is an older format", version->place, hint);
    }
}

}  // namespace mw::machine
