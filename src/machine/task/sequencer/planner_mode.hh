// SPDX-License-Identifier: GPL-2.0-or-later
// Which planner is in force: as the INI file says, as a program asks (G64 R), as pin ini.traj-planner-type
// asks.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "machine/task/status.hh"
#include "motion/interface/command.hh"
#include "motion/interface/parameters.hh"

namespace mw::task {

/// One thread. Changes reach motion only at rest; what cannot be done, or not yet, is said once.
class PlannerMode {
  public:
    struct Hooks {
        std::function<motion::CommandId(const motion::SetParameter &)> send;
        std::function<void(MessageKind, const std::string &)> post;
    };
    explicit PlannerMode(Hooks hooks) : hooks_(std::move(hooks)) {}

    /// Learns the settings that the machine starts with.
    void configure(const std::vector<motion::SetParameter> &parameters);
    /// Says it when jerk limits are asked for and there are none.
    void announce();
    /// Motion is at rest. The command whose answer is to be awaited, 0 when nothing changes.
    motion::CommandId set(int type);
    /// An operator's wish (a pin), granted as soon as `step` is told that all is idle.
    void wish(int type);
    /// Part of the reachable speed in corners of moves that name none, 0.1 to 1; at once. A number outside
    /// gives the nearest that may be, what is no number changes nothing; both are told, and again only after
    /// another fault or a good value.
    void set_corner_scale(double scale);
    void step(bool isIdle);
    int type() const { return type_; }
    double corner_scale() const { return corner_scale_; }

  private:
    /// What was wrong with the wish for corners.
    enum class ScaleFault : std::uint8_t { NONE, NO_NUMBER, TOO_LOW, TOO_HIGH };
    bool isJerkOff() const;

    Hooks hooks_;
    int type_ = 0, wish_ = 0;
    bool isWaitAnnounced_ = false;
    ScaleFault told_fault_ = ScaleFault::NONE;
    double linear_jerk_ = motion::NO_JERK_LIMIT, least_jerk_ = motion::NO_JERK_LIMIT, corner_scale_ = 1;
};

}  // namespace mw::task
