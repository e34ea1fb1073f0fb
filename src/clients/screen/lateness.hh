// SPDX-License-Identifier: GPL-2.0-or-later
// Delay of a text, in the time of its sender.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

namespace mw::screen {

/// The clocks of a browser and of the server have nothing in common but their pace: the text that came
/// fastest in the last seconds is taken as having come at once, and others are later than it by so much. The
/// window is short, so that clocks that drift apart are not taken for lateness.
class Lateness {
  public:
    /// Of a text that was sent at `sent_ms` by its sender's clock. 0 and above [ms]; finite numbers only.
    double of(double sent_ms, std::int64_t now_ns);

  private:
    static constexpr std::int64_t PART_NS = 4000000000;  ///< the window is this part and the one before
    static constexpr double NONE = std::numeric_limits<double>::infinity();
    std::array<double, 2> least_ms_{NONE, NONE};  ///< of this part, and of the one before
    std::int64_t part_ = 0;
};

}  // namespace mw::screen
