// SPDX-License-Identifier: GPL-2.0-or-later
// Inputs that act when they become TRUE.
#pragma once

namespace mw::halui {

/// TRUE at the start is not an edge that somebody has made.
class Edge {
  public:
    /// Whether it has risen since the last call.
    bool step(bool isOn) {
        const bool isRisen = isKnown_ && isOn && !wasOn_;
        wasOn_ = isOn;
        isKnown_ = true;
        return isRisen;
    }

  private:
    bool wasOn_ = false, isKnown_ = false;
};

}  // namespace mw::halui
