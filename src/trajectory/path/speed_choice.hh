// SPDX-License-Identifier: GPL-2.0-or-later
// Speeds chosen by a user's planner module. They are checked before use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "trajectory/path/limits.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// The remaining part of a segment, and the limits for the choice; see mw_tp_stretch. Speeds are along the
/// path [1/s].
struct SpeedStretch {
    double length = 0;
    double speed = 0, cap = 0, out = 0;
    double at_rest = 0, at_cap = 0;  ///< maximum accelerations at speed 0 and at speed `cap` [1/s^2]
    std::int32_t line = 0;
    bool isEnd = false;
};

struct ChosenPhase {
    double length = 0, speed = 0;
};

inline constexpr std::size_t CHOSEN_PHASES = 8;

class SpeedChooser {
  public:
    /// Writes the chosen phases to `out` and returns their number. [planner thread]
    virtual int choose(const SpeedStretch &stretch, std::span<ChosenPhase> out) noexcept = 0;

  protected:
    ~SpeedChooser() = default;
};

/// The error of a choice.
struct Overreach {
    enum class Kind : std::uint8_t {
        NONE,
        NO_ANSWER,  ///< no phases, more phases than fit, or a value that is not a number
        TOO_FAST,   ///< value: speed divided by the maximum
        TOO_HARD,   ///< value: acceleration divided by the maximum
        TOO_LATE,   ///< value: speed at the end divided by the maximum there
        NOT_THERE,  ///< the motion stops before the end, or the sum of the lengths is not the length of the
                    ///< segment
    };
    Kind kind = Kind::NONE;
    double value = 0;
    Sequence move = 0;
};

/// Checks the phases `chosen` that choose() returned. `bound`: maximum acceleration of the segment.
Overreach check_choice(const SpeedStretch &stretch, const AccelBound &bound,
                       std::span<const ChosenPhase> chosen) noexcept;

}  // namespace mw::trajectory
