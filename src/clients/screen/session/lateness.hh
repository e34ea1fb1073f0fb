// SPDX-License-Identifier: GPL-2.0-or-later
// Delay of a text, measured with the clock of its sender.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace mw::screen {

/// The clocks of browser and server differ by an unknown offset. The fastest text of the last seconds counts
/// as received without delay; the delay of other texts is relative to it. The window is short, so that a
/// drift of the clocks is not measured as delay.
class Lateness {
  public:
    /// Delay of a text sent at `sent_ms` by its sender's clock, at least 0 [ms]; finite numbers only.
    double of(double sent_ms, std::int64_t now_ns);

  private:
    static constexpr std::int64_t PART_NS = 4000000000;  ///< the window is the current and the previous part
    static constexpr double NONE = std::numeric_limits<double>::infinity();
    std::array<double, 2> least_ms_{NONE, NONE};  ///< minimum of the current part and of the previous one
    std::int64_t part_ = 0;
};

}  // namespace mw::screen
