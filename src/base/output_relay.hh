// SPDX-License-Identifier: GPL-2.0-or-later
// Standard output and standard error of a program that must never wait for whoever reads them: a terminal
// that was stopped or closed, a pipe that nobody reads, a full disk.
#pragma once

#include <string>

namespace mw {

/// From its begin() on, descriptors 1 and 2 are pipes that a thread of this process empties at once, and
/// other threads write what comes out of them to where both pointed before. What is written there is lost
/// only where that cannot take it: after 256 kB that wait, or an error. Any thread may call.
class OutputRelay {
  public:
    /// Once in a process. Where a pipe or thread cannot be made the output stays as it was: the error says
    /// why.
    static std::string begin();
    /// Why output was lost since the last call, as "the output of this program is lost: No space left on
    /// device"; empty: nothing was lost.
    static std::string take_loss();
    /// Waits at most 0.5 s for what is still to be written. Afterwards both descriptors are as before
    /// begin(), or lead to nothing where they could not be written.
    static void end();
    /// Whether output of `descriptor` (1 or 2) ends up in a terminal.
    static bool isTerminal(int descriptor);
    /// In a forked child before exec: a program with a person at its terminal gets the terminal itself.
    /// Async-signal-safe; does nothing before begin().
    static void restore_in_child() noexcept;
};

}  // namespace mw
