// SPDX-License-Identifier: GPL-2.0-or-later
// [SECTION]NAME of HAL files from an INI file.
#pragma once

#include <string>

#include "config/ini_file.hh"
#include "hal_lang/lang/lexer.hh"

namespace mw::hal::lang {

class IniFileLookup final : public IniLookup {
  public:
    /// `ini` must outlive this.
    explicit IniFileLookup(const config::IniFile &ini) : ini_(ini) {}

    std::optional<std::string> find(std::string_view section, std::string_view name) const override {
        const config::IniEntry *entry = ini_.find(section, name);
        return entry == nullptr ? std::nullopt : std::optional<std::string>(entry->value);
    }
    std::vector<std::string> names(std::string_view section) const override { return ini_.keys(section); }
    std::vector<std::string> values(std::string_view section, std::string_view name) const override {
        std::vector<std::string> values;
        for (const config::IniEntry *entry : ini_.find_all(section, name)) {
            values.push_back(entry->value);
        }
        return values;
    }
    std::vector<std::string> sections() const override { return ini_.sections(); }

  private:
    const config::IniFile &ini_;
};

}  // namespace mw::hal::lang
