// SPDX-License-Identifier: GPL-2.0-or-later
// Inputs that act when they become TRUE.
#pragma once

namespace mw::halui {

/// Detects rising edges. TRUE at the start is not an edge.
class Edge {
  public:
    /// True if the input has risen since the last call.
    bool step(bool on) {
        const bool risen = known_ && on && !was_on_;
        was_on_ = on;
        known_ = true;
        return risen;
    }

  private:
    bool was_on_ = false, known_ = false;
};

}  // namespace mw::halui
