// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/loaded_config.hh"

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

}  // namespace mw::machine
