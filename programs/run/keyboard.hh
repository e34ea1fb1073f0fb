// SPDX-License-Identifier: GPL-2.0-or-later
// Reads single keys from the terminal of the program, without waiting for them.
#pragma once

#include <termios.h>

#include <optional>

namespace mw::programs {

/// Reads single keys from the terminal during its lifetime: without echo, without Enter, and without
/// suspending by Ctrl-Z (task must not stop while a machine moves). The destructor restores the terminal.
class Keyboard {
  public:
    /// True if standard input is a terminal and this program is in its foreground.
    static bool isThere();

    Keyboard();
    ~Keyboard();
    Keyboard(const Keyboard &) = delete;
    Keyboard &operator=(const Keyboard &) = delete;

    /// The next key; nothing if there is none. Does not block. Ignores keys that send several characters
    /// (arrows).
    std::optional<char> read();

  private:
    bool taken_ = false;
    termios before_{};
};

}  // namespace mw::programs
