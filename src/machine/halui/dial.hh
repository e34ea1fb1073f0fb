// SPDX-License-Identifier: GPL-2.0-or-later
// A wheel with buttons that sets a value: an override or the highest speed.
#pragma once

#include <optional>

#include "machine/halui/edge.hh"
#include "machine/halui/pin_tables.hh"

namespace mw::halui {

struct DialRange {
    double low = 0, high = 1;
};

class Dial {
  public:
    /// Once a cycle: the value that is asked for now, within the range; nothing when nobody has touched it.
    /// `value` is in force.
    std::optional<double> step(const DialInputs &now, double value, const DialRange &range);
    /// What was asked for is in force, or was refused: the next change begins at what is shown.
    void settle() { asked_.reset(); }

  private:
    bool isKnown_ = false;
    std::int32_t counts_ = 0;
    Edge increase_, decrease_, reset_;
    std::optional<double> asked_;
};

}  // namespace mw::halui
