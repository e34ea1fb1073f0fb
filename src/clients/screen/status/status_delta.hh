// SPDX-License-Identifier: GPL-2.0-or-later
// The status for a browser: first completely, then changes.
#pragma once

#include <memory>
#include <string>

#include "messages/declarations/status_parts.hh"

namespace mw::screen {

/// For one browser. All calls come from one thread.
class StatusDelta {
  public:
    /// The complete status as JSON; later changes are relative to it.
    std::string whole(const messages::MachineStatus &now);
    /// The fields that differ from the last status, nested as in the complete status; of an array the changed
    /// elements, by index: {"joints":{"2":{"pos_cmd":4.5}}}. Empty if there are none. Only `parts`
    /// (messages::status_part) are compared: the parts that were read since the last call.
    std::string next(const messages::MachineStatus &now, PartMask parts = messages::PublishedStatus::ALL);

  private:
    std::unique_ptr<messages::MachineStatus> told_ = std::make_unique<messages::MachineStatus>();
};

}  // namespace mw::screen
