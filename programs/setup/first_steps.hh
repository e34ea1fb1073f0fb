// SPDX-License-Identifier: GPL-2.0-or-later
// First steps in a browser: configurations to choose from, and the wizard for a new one.
#pragma once

#include <string>

#include "clients/screen/first_steps.hh"
#include "programs/setup/configurations.hh"

namespace mw::programs {

/// Set while a page of ours waits for the machine's screen, so that no other one is opened.
inline constexpr const char *BROWSER_WAITS = "MILLWRIGHT_BROWSER_WAITS";

/// As a person sees it: kind, axes, notes and picture from the INI file and what lies beside it.
screen::Choice choice_of(const Configuration &configuration);

/// The port of the screen that [DISPLAY]DISPLAY names; 0: another screen.
int screen_port(const std::string &display);

/// Serves the page on 127.0.0.1:`port` (0: a free one) until somebody chooses or a stop signal comes; with
/// `isOpening` in the desktop's browser. @return the INI file, whole path, remembered as the last one; empty
/// when nobody has chosen
Result<std::string> select_in_browser(int port, bool isOpening);

}  // namespace mw::programs
