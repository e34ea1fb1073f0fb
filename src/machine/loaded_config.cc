// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/loaded_config.hh"

#include "base/text.hh"

namespace mw::machine {

std::unique_ptr<LoadedConfig> LoadedConfig::load(const std::string &path, diag::Sink &sink) {
    auto file = config::IniFile::load(path, sink);
    if (!file.has_value()) {
        sink.error(file.error());
        return nullptr;
    }
    auto loaded = std::make_unique<LoadedConfig>(std::move(*file), sink);
    return sink.hasErrors() ? nullptr : std::move(loaded);
}

/// One word of [KINS]KINEMATICS says it.
msgs::Kinematics MachineConfig::kinematics_kind() const {
    bool isIdentity = isTrivial;
    for (const std::string &word : kinematics) {
        isIdentity &= !to_lower(word).starts_with("kinstype=b");
    }
    return isIdentity ? msgs::Kinematics::IDENTITY : msgs::Kinematics::BOTH;
}

}  // namespace mw::machine
