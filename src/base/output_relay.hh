// SPDX-License-Identifier: GPL-2.0-or-later
// Standard output and standard error of a program that must never wait for their reader: a terminal that was
// stopped or closed, a pipe without a reader, a full disk.
#pragma once

#include <string>

namespace mw {

/// After begin(), descriptors 1 and 2 are pipes. One thread of this process empties them at once; other
/// threads write the data to the original destinations. Output is lost only when a destination does not
/// accept it: after 256 kB of waiting data, or on an error. [any thread]
class OutputRelay {
  public:
    /// Call once in a process. If a pipe or thread cannot be created, output is not redirected and the reason
    /// is returned.
    static std::string begin();
    /// The reason why output was lost since the last call, as "the output of this program is lost: No space
    /// left on device". Empty if nothing was lost.
    static std::string take_loss();
    /// Waits at most 0.5 s for pending output. Afterwards both descriptors are as before begin(), or discard
    /// output if they could not be written.
    static void end();
    /// True if the output of `descriptor` (1 or 2) is a terminal.
    static bool isTerminal(int descriptor);
    /// Call in a forked child before exec: a program with a person at its terminal gets the terminal itself.
    /// Async-signal-safe; no effect before begin().
    static void restore_in_child() noexcept;
};

}  // namespace mw
