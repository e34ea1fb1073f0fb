// SPDX-License-Identifier: GPL-2.0-or-later
// The files of the screen, and the desktop browser that shows it.
#pragma once

#include <sys/types.h>

#include <string>

#include "base/result.hh"

namespace mw::programs {

/// Default port of a screen.
inline constexpr int SCREEN_PORT = 8850;

/// The installed folder, or that of the build folder; `given` if it is not empty.
std::string screen_folder(const std::string &given);
/// An error if the folder has no screen, because its address would show an error in the browser.
Result<> check_screen(const std::string &folder);

class Browser {
  public:
    /// Opens the address if there is a desktop; does not wait.
    void open(const std::string &address);
    /// Call it periodically: it waits for the program that opens the address.
    void look();

  private:
    pid_t pid_ = 0;
};

}  // namespace mw::programs
