// SPDX-License-Identifier: GPL-2.0-or-later
// The screen's files, and the desktop's browser that shows it.
#pragma once

#include <sys/types.h>

#include <string>

#include "base/result.hh"

namespace mw::programs {

/// Where a screen is served that has no other port.
inline constexpr int SCREEN_PORT = 8850;

/// Installed, and in the build folder; `given` where it is not empty.
std::string screen_folder(const std::string &given);
/// An error where the folder has no screen: an address of it would show an error in the browser.
Result<> check_screen(const std::string &folder);

class Browser {
  public:
    /// Where there is a desktop; what opens it goes its own way.
    void open(const std::string &address);
    /// Now and then: whether what opens it has ended.
    void look();

  private:
    pid_t pid_ = 0;
};

}  // namespace mw::programs
