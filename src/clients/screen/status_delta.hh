// SPDX-License-Identifier: GPL-2.0-or-later
// The status as a browser gets it: whole at first, then what has changed since.
#pragma once

#include <memory>
#include <string>

#include "messages/declarations/status_parts.hh"

namespace mw::screen {

/// Of one browser. One thread.
class StatusDelta {
  public:
    /// The whole status as JSON; later changes are relative to it.
    std::string whole(const messages::MachineStatus &now);
    /// The fields that are other than told last, nested as in the whole; of an array the elements, by index:
    /// {"joints":{"2":{"pos_cmd":4.5}}}. Empty when nothing is. Only `parts` (messages::status_part) are
    /// compared: those that have been read since.
    std::string next(const messages::MachineStatus &now, PartMask parts = messages::PublishedStatus::ALL);

  private:
    std::unique_ptr<messages::MachineStatus> told_ = std::make_unique<messages::MachineStatus>();
};

}  // namespace mw::screen
