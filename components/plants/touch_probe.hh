// SPDX-License-Identifier: GPL-2.0-or-later
// A touch probe above a surface: contact is made a pretravel after the touch, and ends with the surface.
// Realtime-safe.
#pragma once

namespace mw::plants {

class TouchProbe {
  public:
    enum class Fault { NONE, STUCK_OPEN, STUCK_CLOSED };

    TouchProbe() noexcept = default;
    /// The surface is at `surface` and below; `pretravel` is the distance that the tip moves before it
    /// switches.
    TouchProbe(double surface, double pretravel) noexcept : surface_(surface), pretravel_(pretravel) {}

    bool isClosed(double tip) const noexcept {
        const bool touching = tip <= surface_ - pretravel_;
        return fault_ == Fault::NONE ? touching : fault_ == Fault::STUCK_CLOSED;
    }
    void set_fault(Fault fault) noexcept { fault_ = fault; }

  private:
    double surface_ = -1e300;
    double pretravel_ = 0;
    Fault fault_ = Fault::NONE;
};

}  // namespace mw::plants
