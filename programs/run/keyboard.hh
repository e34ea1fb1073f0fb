// SPDX-License-Identifier: GPL-2.0-or-later
// Single keys of the terminal that the program runs in, without waiting for them.
#pragma once

#include <termios.h>

#include <optional>

namespace mw::programs {

/// Takes the terminal's keys one by one while it lives: no echo, no end of line needed, no suspending by
/// Ctrl-Z (task must not stand still while a machine moves). Restores the terminal at its end.
class Keyboard {
  public:
    /// Standard input is a terminal and this program is in its foreground.
    static bool isThere();

    Keyboard();
    ~Keyboard();
    Keyboard(const Keyboard &) = delete;
    Keyboard &operator=(const Keyboard &) = delete;

    /// The next key; nothing when there is none. Never blocks. Keys that send more than one character
    /// (arrows) are no keys.
    std::optional<char> read();

  private:
    bool isTaken_ = false;
    termios before_{};
};

}  // namespace mw::programs
