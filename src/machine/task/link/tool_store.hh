// SPDX-License-Identifier: GPL-2.0-or-later
// The one owner of the tool data (requirement G4), as task uses it.
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
    /// Puts the tool of table entry `index` (0: none, of a random changer: the one that is there) into the
    /// spindle, by the rules of the changer, and keeps that. An error: it is so, but could not be kept. Never
    /// waits for a disk.
    virtual Result<> load_spindle(int index) = 0;
    /// Changes the data of the tool that `entry` names, and keeps them; `index` is where it was last. Never
    /// waits for a disk.
    virtual Result<> set_entry(int index, const gcode::ToolEntry &entry) = 0;
    /// Puts a new tool into the table and keeps it; pocket 0: one that is free. Nothing has changed on an
    /// error. Waits for the disk.
    virtual Result<> add(const gcode::ToolEntry &) { return fail("tools are not added here"); }
    /// Takes one out, that is not in the spindle; the others keep their indices. Nothing has changed on an
    /// error. Waits for the disk.
    virtual Result<> remove(int) { return fail("tools are not removed here"); }
    /// Waits until all changes are on the disk.
    virtual Result<> save() { return {}; }
    /// All changes are on the disk, or cannot be written, or the disk has not answered for 1 s.
    virtual bool isSettled() const { return true; }
    /// Begins to read the tools again.
    virtual Result<> reload() = 0;
    /// How the reading has ended; nothing before its end.
    virtual std::optional<Result<>> reload_result() { return Result<>{}; }
    /// What is read later changes nothing.
    virtual void drop_reload() {}
    /// Once a cycle; never blocks.
    virtual void step() {}
    /// What the operator is to know of the data's keeper: nothing when there is no more.
    virtual std::optional<std::string> take_warning() { return std::nullopt; }
    /// The tool has cut this much more, and all in its life.
    virtual void note_cut(int, const tools::CutLife &) {}
    virtual tools::CutLife life(int) const { return {}; }
    /// Another number after each change; never 0.
    virtual std::uint64_t version() const = 0;
};

}  // namespace mw::task
