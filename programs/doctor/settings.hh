// SPDX-License-Identifier: GPL-2.0-or-later
// Single settings as numbers, for comparisons. Reading the machine reports invalid numbers.
#pragma once

#include <optional>
#include <string>

#include "base/ini/ini_file.hh"

namespace mw::doctor {

/// A numeric setting and its position.
struct Setting {
    double value = 0;
    const ini::IniEntry *entry = nullptr;

    /// "[JOINT_0]MAX_VELOCITY = 5"
    std::string str() const;
    const SourcePlace &place() const { return entry->place; }
};

/// The first setting of that name; nothing if there is none or it is not a number.
std::optional<Setting> number(const ini::IniFile &ini, const std::string &section, const char *key);

/// Its text up to a comment; empty if there is none.
std::string text(const ini::IniFile &ini, const std::string &section, const char *key);

}  // namespace mw::doctor
