// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/settings.hh"

#include "base/text.hh"

namespace mw::doctor {

std::string Setting::str() const {
    return '[' + entry->section + ']' + entry->key + " = " + to_text(value);
}

std::optional<Setting> number(const ini::IniFile &ini, const std::string &section, const char *key) {
    const ini::IniEntry *const entry = ini.find(section, key);
    const auto words = split_words(entry != nullptr ? entry->value : std::string());
    const auto value = words.empty() ? std::nullopt : parse_double(words[0]);
    return value.has_value() ? std::optional(Setting{*value, entry}) : std::nullopt;
}

std::string text(const ini::IniFile &ini, const std::string &section, const char *key) {
    const ini::IniEntry *const entry = ini.find(section, key);
    std::string all;
    for (const std::string &word : split_words(entry != nullptr ? entry->value : std::string())) {
        if (word[0] == '#' || word[0] == ';') {
            break;
        }
        all += (all.empty() ? "" : " ") + word;
    }
    return all;
}

}  // namespace mw::doctor
