// SPDX-License-Identifier: GPL-2.0-or-later
// Speeds chosen by a user's planner module. They are checked before they are used.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "trajectory/path/limits.hh"
#include "trajectory/path_store.hh"

namespace mw::trajectory {

/// What is left of a piece, and what may be chosen; see mw_tp_stretch. Speeds along the path [1/s].
struct SpeedStretch {
    double length = 0;
    double speed = 0, cap = 0, out = 0;
    double at_rest = 0, at_cap = 0;  ///< accelerations [1/s^2]
    std::int32_t line = 0;
    bool isEnd = false;
};

struct ChosenPhase {
    double length = 0, speed = 0;
};

inline constexpr std::size_t CHOSEN_PHASES = 8;

class SpeedChooser {
  public:
    /// Fills `out`; how many. [planner thread]
    virtual int choose(const SpeedStretch &stretch, std::span<ChosenPhase> out) noexcept = 0;

  protected:
    ~SpeedChooser() = default;
};

/// What is wrong with a choice.
struct Overreach {
    enum class Kind : std::uint8_t {
        NONE,
        NO_ANSWER,  ///< no phases, more than fit, or a value that is no number
        TOO_FAST,   ///< value: the speed over the maximum
        TOO_HARD,   ///< value: the acceleration over the maximum
        TOO_LATE,   ///< value: the speed at the end over the maximum there
        NOT_THERE,  ///< stops before the end, or the lengths do not add up to the segment
    };
    Kind kind = Kind::NONE;
    double value = 0;
    Sequence move = 0;
};

/// `bound`: of the piece. `chosen` are what `choose` gave.
Overreach check_choice(const SpeedStretch &stretch, const AccelBound &bound,
                       std::span<const ChosenPhase> chosen) noexcept;

}  // namespace mw::trajectory
