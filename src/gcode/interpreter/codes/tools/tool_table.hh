// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table with the changes of the program.
#pragma once

#include <map>

#include "gcode/interpreter/world.hh"

namespace mw::gcode::detail {

/// Entries set by G10 override those of the source until the owner of the table has stored them. A change
/// takes effect at once and is dropped when its block fails.
class ToolTable {
  public:
    explicit ToolTable(const ToolSource &source) : source_(source) {}

    int count() const { return source_.count(); }
    bool isRandom() const { return source_.isRandom(); }
    int index_of_tool(int toolno) const { return source_.index_of_tool(toolno); }
    ToolEntry entry(int index) const;
    void set(int index, const ToolEntry &entry) { of_block_[index] = entry; }
    void commit();
    void rollback() { of_block_.clear(); }
    bool hasChanges() const { return !changes_.empty(); }
    /// Called when the source has all changes.
    void forget() { changes_.clear(); }

  private:
    const ToolSource &source_;
    std::map<int, ToolEntry> changes_, of_block_;
};

}  // namespace mw::gcode::detail
