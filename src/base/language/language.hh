// SPDX-License-Identifier: GPL-2.0-or-later
// Selects the language for the texts that this process shows, as gettext does.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/language/catalogue.hh"
#include "base/result.hh"

namespace mw::language {

/// The requested languages in order of preference ("de_AT", "de"): LANGUAGE, if one of LC_ALL, LC_MESSAGES,
/// LANG names a locale other than C; then that locale. Empty: English. @param get returns an environment
/// variable, null if it is not set
std::vector<std::string> wanted(const std::function<const char *(const char *)> &get);

/// The catalogue for the environment of this process. The first call reads it from share/locale above our
/// folder; empty if there is no catalogue. A catalogue that cannot be read is reported once on standard
/// error.
const Catalogue &catalogue();

/// `english` in the language of the environment. For texts that a person reads, not for texts that a program
/// reads. [any thread, not realtime]
std::string shown(std::string_view english);

/// Prints `english` as a line on standard error, in the language of the environment. Output for programs goes
/// to standard output in English.
void tell(std::string_view english);

/// Prints "PROGRAM: ERROR".
void tell(std::string_view program, const Error &error);

}  // namespace mw::language
