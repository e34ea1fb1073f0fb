// SPDX-License-Identifier: GPL-2.0-or-later
// First steps in a browser: configurations to choose from, and the wizard for a new one.
#pragma once

#include <string>

#include "clients/screen/setup/first_steps.hh"
#include "programs/setup/configurations.hh"

namespace mw::programs {

/// Set while one of our pages waits for the machine's screen, so that no second page is opened.
inline constexpr const char *BROWSER_WAITS = "MILLWRIGHT_BROWSER_WAITS";

/// Data for the user: type, axes, notes and picture, from the INI file and files beside it.
screen::Choice choice_of(const Configuration &configuration);

/// The port of the screen in [DISPLAY]DISPLAY; 0: another screen.
int screen_port(const std::string &display);

/// Serves the page on 127.0.0.1:`port` (0: any free port) until a selection or a stop signal. With
/// `isOpening` opens it in the desktop's browser. @return the absolute path of the INI file, stored as the
/// last one; empty without a selection
Result<std::string> select_in_browser(int port, bool opening);

}  // namespace mw::programs
