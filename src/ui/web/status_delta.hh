// SPDX-License-Identifier: GPL-2.0-or-later
// The status as a browser gets it: whole at first, then what has changed since.
#pragma once

#include <memory>
#include <string>

#include "msgs/status_parts.hh"

namespace mw::ui::web {

/// Of one browser. One thread.
class StatusDelta {
  public:
    /// The whole status as JSON; what follows is told against it.
    std::string whole(const msgs::MachineStatus &now);
    /// The fields that are other than told last, nested as in the whole; of an array the elements, by index:
    /// {"joints":{"2":{"pos_cmd":4.5}}}. Empty when nothing is. Only `parts` (msgs::status_part) are looked
    /// at: those that have been read since.
    std::string next(const msgs::MachineStatus &now, PartMask parts = msgs::PublishedStatus::ALL);

  private:
    std::unique_ptr<msgs::MachineStatus> told_ = std::make_unique<msgs::MachineStatus>();
};

}  // namespace mw::ui::web
