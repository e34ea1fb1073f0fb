// SPDX-License-Identifier: GPL-2.0-or-later
// The modal codes of blocks that are read but not done. Programs are read ahead, while clients see the codes
// of the current move.
#pragma once

#include <cstdint>
#include <deque>

#include "gcode/interpreter/program_interpreter.hh"

namespace mw::task {

/// All calls come from one thread.
class ModalCodeHistory {
  public:
    /// Stores the codes after the block with this number was read. Blocks arrive in order. If a block is
    /// noted again while it waits for the machine, its first codes are kept.
    void note(std::uint32_t block, const gcode::ActiveCodes &codes);
    /// Codes at a block; codes of at least one block must be stored. `line` replaces the sequence numbers.
    gcode::ActiveCodes at(std::uint32_t block, int line) const;
    bool isEmpty() const { return entries_.empty(); }
    void clear() { entries_.clear(); }

  private:
    /// Number of past entries kept, for a reverse run.
    static constexpr std::size_t MAX_ENTRIES = 20000;

    struct Entry {
        std::uint32_t block = 0;  ///< first block with these codes
        gcode::ActiveCodes codes;
    };
    std::deque<Entry> entries_;
    std::uint32_t newest_ = 0;
};

/// The codes with another sequence number.
gcode::ActiveCodes numbered(gcode::ActiveCodes codes, int line);

}  // namespace mw::task
