// SPDX-License-Identifier: GPL-2.0-or-later
// A wheel with buttons that sets a value: an override or the maximum velocity.
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
    /// Called once in each cycle. Returns the new requested value, within the range; nothing without input.
    /// `value` is the current value.
    std::optional<double> step(const DialInputs &now, double value, const DialRange &range);
    /// Called when the request has been applied or rejected. The next change then starts at the current
    /// value.
    void settle() { asked_.reset(); }

  private:
    bool known_ = false;
    std::int32_t counts_ = 0;
    Edge increase_, decrease_, reset_;
    std::optional<double> asked_;
};

}  // namespace mw::halui
