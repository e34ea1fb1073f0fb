// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/config/loaded_config.hh"

#include "base/text.hh"

namespace mw::machine {

std::unique_ptr<LoadedConfig> LoadedConfig::load(const std::string &path, diagnostics::Sink &sink) {
    auto file = ini::IniFile::load(path, sink);
    if (!file.has_value()) {
        sink.error(file.error());
        return nullptr;
    }
    auto loaded = std::make_unique<LoadedConfig>(std::move(*file), sink);
    return sink.hasErrors() ? nullptr : std::move(loaded);
}

/// Type of the kinematics by the first word of [KINS]KINEMATICS.
messages::Kinematics MachineConfig::kinematics_kind() const {
    bool identity = isTrivial;
    for (const std::string &word : kinematics) {
        identity &= !to_lower(word).starts_with("kinstype=b");
    }
    return identity ? messages::Kinematics::IDENTITY : messages::Kinematics::BOTH;
}

}  // namespace mw::machine
