// SPDX-License-Identifier: GPL-2.0-or-later
// Formats in which linuxcncrsh and the Tcl package Linuxcnc write the values of status_table.hh.
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

#include "messages/declarations/describe.hh"

namespace mw::legacy {

enum class Form : std::uint8_t {
    NONE,     ///< only for Python and halui
    NUMBER,   ///< 7
    BITS,     ///< 0x00000003; 3 in OLD_RSH and TCL
    PERCENT,  ///< a factor in percent: 1.0 is 100
    POSE,     ///< one number for each axis; lengths and angles in the units of the client
    LENGTH,   ///< a length of a joint, in the units of the client
    WORD,     ///< in lower case in TCL
    TYPE,     ///< a word; OLD_RSH writes it after two blanks when one joint is requested
    PATH,     ///< unchanged; NONE if there is no path
    ON_OFF,   ///< ON, OFF
    SWITCH,   ///< ON, OFF; 1, 0 in OLD_RSH and TCL
    TELEOP,   ///< ON, OFF; YES, NO in OLD_RSH; 1, 0 in TCL
    YES_NO,   ///< YES, NO; 1, 0 in OLD_RSH and TCL
    DIGIT,    ///< 1, 0
    HOMED,    ///< YES, NO; for homed joints, not in TCL
};

/// linuxcncrsh, linuxcncrsh of LinuxCNC 2.9, and Tcl.
enum class Dialect : std::uint8_t { RSH, OLD_RSH, TCL };

/// The value without a name. If the form does not fit the type, the value is written as NUMBER or WORD.
std::string text(Form form, Dialect dialect, bool value);
std::string text(Form form, Dialect dialect, std::int64_t value);
std::string text(Form form, Dialect dialect, double value);
std::string text(Form form, Dialect dialect, const std::string &value);
template <class Value>
std::string text(Form form, Dialect dialect, const Value &value) {
    if constexpr (std::is_enum_v<Value>) {
        for (const messages::Name &name : messages::NAMES<Value>) {
            if (form == Form::WORD && name.value == static_cast<std::int64_t>(value)) {
                return text(form, dialect, std::string(name.name));
            }
        }
    }
    return text(form, dialect, static_cast<std::int64_t>(value));
}

}  // namespace mw::legacy
