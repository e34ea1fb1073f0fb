// SPDX-License-Identifier: GPL-2.0-or-later
// An INI file together with all files that were read from it.
#pragma once

#include <memory>
#include <string>

#include "base/ini/ini_reader.hh"
#include "machine/config/confinement_config.hh"
#include "machine/config/machine_config.hh"

namespace mw::machine {

struct LoadedConfig {
    LoadedConfig(ini::IniFile file, diagnostics::Sink &sink)
        : ini(std::move(file)), reader(ini, sink), machine(read_machine_config(reader)) {
        machine.task.confinement = read_confinement(ini, machine.task.parameter_file);
    }
    /// Null when the file cannot be read or has errors; the errors are in the sink.
    static std::unique_ptr<LoadedConfig> load(const std::string &path, diagnostics::Sink &sink);

    ini::IniFile ini;
    ini::IniReader reader;
    MachineConfig machine;
};

}  // namespace mw::machine
