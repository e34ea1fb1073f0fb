// SPDX-License-Identifier: GPL-2.0-or-later
// The only owner of the tool data (requirement G4), as used by task.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "base/result.hh"
#include "gcode/interpreter/world.hh"
#include "gcode/tools/life.hh"

namespace mw::task {

class ToolStore : public gcode::ToolSource {
  public:
    /// Loads the tool of table entry `index` (0: no tool; random changer: the current tool) into the spindle,
    /// by the rules of the changer, and stores the table. On an error the tool is loaded but could not be
    /// stored. Does not wait for a disk.
    virtual Result<> load_spindle(int index) = 0;
    /// Changes the data of the tool in `entry`, and stores them; `index` is its last index. Does not wait for
    /// a disk.
    virtual Result<> set_entry(int index, const gcode::ToolEntry &entry) = 0;
    /// Adds a tool to the table and stores it; pocket 0 selects a free pocket. An error changes nothing.
    /// Waits for the disk.
    virtual Result<> add(const gcode::ToolEntry &entry) = 0;
    /// Removes a tool that is not in the spindle; other tools keep their indices. An error changes nothing.
    /// Waits for the disk.
    virtual Result<> remove(int index) = 0;
    /// Waits until all changes are on the disk.
    virtual Result<> save() { return {}; }
    /// True if all changes are on the disk, or cannot be written, or the disk has not answered for 1 s.
    virtual bool isSettled() const { return true; }
    /// Starts reading the tools again.
    virtual Result<> reload() = 0;
    /// Result of reading; nothing before its end.
    virtual std::optional<Result<>> reload_result() { return Result<>{}; }
    /// Discards the result of a read in progress.
    virtual void drop_reload() {}
    /// Called once in each cycle; never blocks.
    virtual void step() {}
    /// Next message for the operator, if any.
    virtual std::optional<std::string> take_warning() { return std::nullopt; }
    /// Adds to the cutting time and length of the tool.
    virtual void note_cut(int, const tools::CutLife &) {}
    virtual tools::CutLife life(int) const { return {}; }
    /// Changes with each modification; never 0.
    virtual std::uint64_t version() const = 0;
};

}  // namespace mw::task
