// SPDX-License-Identifier: GPL-2.0-or-later
// The active planner, selected by the INI file, by a program (G64 R), or by pin ini.traj-planner-type.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "machine/task/status.hh"
#include "motion/interface/command.hh"
#include "motion/interface/parameters.hh"

namespace mw::task {

/// All calls come from one thread. Motion is changed only at standstill; a change that is delayed or not
/// possible is reported once.
class PlannerMode {
  public:
    struct Hooks {
        std::function<motion::CommandId(const motion::SetParameter &)> send;
        std::function<void(MessageKind, const std::string &)> post;
    };
    explicit PlannerMode(Hooks hooks) : hooks_(std::move(hooks)) {}

    /// Reads the initial settings of the machine.
    void configure(const std::vector<motion::SetParameter> &parameters);
    /// Reports jerk limits that are selected and not configured.
    void announce();
    /// Sets the planner while motion is stopped. Returns the command whose answer is awaited, 0 if nothing
    /// changes.
    motion::CommandId set(int type);
    /// A change requested by an operator (a pin), applied when `step` finds everything idle.
    void wish(int type);
    /// Fraction of the reachable speed in corners for moves that set none, 0.1 to 1; takes effect at once. A
    /// value out of range is limited, NaN is ignored. Both are reported once, and again only after another
    /// fault or a valid value.
    void set_corner_scale(double scale);
    void step(bool idle);
    int type() const { return type_; }
    double corner_scale() const { return corner_scale_; }

  private:
    /// The fault of the last corner scale.
    enum class ScaleFault : std::uint8_t { NONE, NO_NUMBER, TOO_LOW, TOO_HIGH };
    bool isJerkOff() const;

    Hooks hooks_;
    int type_ = 0, wish_ = 0;
    bool wait_announced_ = false;
    ScaleFault told_fault_ = ScaleFault::NONE;
    double linear_jerk_ = motion::NO_JERK_LIMIT, least_jerk_ = motion::NO_JERK_LIMIT, corner_scale_ = 1;
};

}  // namespace mw::task
