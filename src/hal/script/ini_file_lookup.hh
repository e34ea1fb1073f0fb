// SPDX-License-Identifier: GPL-2.0-or-later
// [SECTION]NAME of HAL files from an INI file.
#pragma once

#include <string>

#include "base/ini/ini_file.hh"
#include "hal/script/lexer.hh"

namespace mw::hal::script {

class IniFileLookup final : public IniLookup {
  public:
    /// `ini` must outlive this.
    explicit IniFileLookup(const ini::IniFile &ini) : ini_(ini) {}

    std::optional<std::string> find(std::string_view section, std::string_view name) const override {
        const ini::IniEntry *entry = ini_.find(section, name);
        return entry == nullptr ? std::nullopt : std::optional<std::string>(entry->value);
    }
    std::vector<std::string> names(std::string_view section) const override { return ini_.keys(section); }
    std::vector<std::string> values(std::string_view section, std::string_view name) const override {
        std::vector<std::string> values;
        for (const ini::IniEntry *entry : ini_.find_all(section, name)) {
            values.push_back(entry->value);
        }
        return values;
    }
    std::vector<std::string> sections() const override { return ini_.sections(); }

  private:
    const ini::IniFile &ini_;
};

}  // namespace mw::hal::script
