// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table for clients: sent again after each change.
#pragma once

#include <optional>

#include "machine/task/link/tool_store.hh"
#include "messages/declarations/status.hh"

namespace mw::task {

/// One thread.
class ShownTools {
  public:
    /// Once a cycle. The table if its version has changed since the last call.
    std::optional<messages::ToolTable> step(const ToolStore &tools);
    std::uint64_t version() const { return version_; }

  private:
    std::uint64_t version_ = 0;
};

}  // namespace mw::task
