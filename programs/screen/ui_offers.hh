// SPDX-License-Identifier: GPL-2.0-or-later
// The folder in which `millwright publish` stores the offers of a shop.
#pragma once

#include <string>

#include "base/ini/ini_file.hh"

namespace mw::programs {

/// Empty if [PUBLISH] of the machine receives no offers, or has errors, which `millwright publish` reports.
std::string offers_folder(const ini::IniFile &ini);

}  // namespace mw::programs
