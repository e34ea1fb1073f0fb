// SPDX-License-Identifier: GPL-2.0-or-later
// The one owner of the tool data (requirement G4), as task uses it.
#pragma once

#include <cstdint>

#include "base/result.hh"
#include "interp/world.hh"

namespace mw::task {

class ToolStore : public interp::ToolSource {
  public:
    /// Puts the tool of table entry `index` (0: none) into the spindle, by the rules of the changer.
    virtual Result<> load_spindle(int index) = 0;
    /// Changes an entry and saves the table.
    virtual Result<> set_entry(int index, const interp::ToolEntry &entry) = 0;
    virtual Result<> reload() = 0;
    /// Another number after each change; never 0.
    virtual std::uint64_t version() const = 0;
};

}  // namespace mw::task
