// SPDX-License-Identifier: GPL-2.0-or-later
// The language of the person whom this process shows texts to, as gettext finds it out.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/language/catalogue.hh"
#include "base/result.hh"

namespace mw::language {

/// The languages that are asked for, the best one first ("de_AT", "de"): LANGUAGE, but only where one of
/// LC_ALL, LC_MESSAGES, LANG names a locale other than C; then that one. Empty: English.
/// @param get the value of a variable of the environment, null where it is not set
std::vector<std::string> wanted(const std::function<const char *(const char *)> &get);

/// The catalogue of this process's environment, read at the first call from share/locale above the folder of
/// our code; empty where there is none. A catalogue that cannot be read is told on standard error once.
const Catalogue &catalogue();

/// `english` in the language of this process's environment: call it where a text is shown to a person, never
/// where a program reads it. Any thread, not realtime.
std::string shown(std::string_view english);

/// Prints `english` as a line on standard error, in the language of this process's environment. Standard
/// error is for people; what programs read goes to standard output in English.
void tell(std::string_view english);

/// The same for "PROGRAM: ERROR".
void tell(std::string_view program, const Error &error);

}  // namespace mw::language
