// SPDX-License-Identifier: GPL-2.0-or-later
// The screen's files, and the desktop's browser that shows it.
#pragma once

#include <sys/types.h>

#include <string>

namespace mw::app {

/// Where a screen is served that has no other port.
inline constexpr int SCREEN_PORT = 8850;

/// Installed, and in the build folder; `given` where it is not empty.
std::string screen_folder(const std::string &given);

class Browser {
  public:
    /// Where there is a desktop and a screen to show; what opens it goes its own way.
    void open(const std::string &address, const std::string &folder);
    /// Now and then: whether what opens it has ended.
    void look();

  private:
    pid_t pid_ = 0;
};

}  // namespace mw::app
