// SPDX-License-Identifier: GPL-2.0-or-later
// Single settings as numbers, for comparisons. What is no number is told by who reads the machine.
#pragma once

#include <optional>
#include <string>

#include "base/ini/ini_file.hh"

namespace mw::doctor {

/// A setting that is a number, and where it stands.
struct Setting {
    double value = 0;
    const ini::IniEntry *entry = nullptr;

    /// "[JOINT_0]MAX_VELOCITY = 5"
    std::string str() const;
    const SourcePlace &place() const { return entry->place; }
};

/// The first setting of that name; nothing where there is none or it is no number.
std::optional<Setting> number(const ini::IniFile &ini, const std::string &section, const char *key);

/// Its text up to a comment; empty where there is none.
std::string text(const ini::IniFile &ini, const std::string &section, const char *key);

}  // namespace mw::doctor
