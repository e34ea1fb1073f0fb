// SPDX-License-Identifier: GPL-2.0-or-later
// The modal codes of the blocks that are read and not done: programs are read ahead, people are shown what
// holds for the move under way.
#pragma once

#include <cstdint>
#include <deque>

#include "gcode/interpreter/program_interpreter.hh"

namespace mw::task {

/// One thread.
class ModalCodeHistory {
  public:
    /// The codes once the block of that number has been read. Blocks come in their order; of one that is told
    /// again, while it waits for the machine, the first telling counts.
    void note(std::uint32_t block, const gcode::ActiveCodes &codes);
    /// What holds in a block; something has been noted. `line` takes the place of the sequence
    /// numbers.
    gcode::ActiveCodes at(std::uint32_t block, int line) const;
    bool isEmpty() const { return entries_.empty(); }
    void clear() { entries_.clear(); }

  private:
    /// Places of the past that are kept: a path can be gone back along.
    static constexpr std::size_t MAX_ENTRIES = 20000;

    struct Entry {
        std::uint32_t block = 0;  ///< from which on they hold
        gcode::ActiveCodes codes;
    };
    std::deque<Entry> entries_;
    std::uint32_t newest_ = 0;
};

/// With another sequence number.
gcode::ActiveCodes numbered(gcode::ActiveCodes codes, int line);

}  // namespace mw::task
