// SPDX-License-Identifier: GPL-2.0-or-later
// spindle_monitor: detects whether a spindle has reached its speed, and whether it has lost it.
// After `spindle-is-on` (bit) became true, `spindle-at-speed` (bit) becomes true once `spindle-feedback` is
// within the parameter `threshold` of `spindle-command` (float); from then on `spindle-underspeed` (bit)
// becomes true when the feedback is slower than the command by more than threshold. Both are kept until
// spindle-is-on is false. The parameter `level` (u32) is the state: 0 off, 1 accelerating, 2 at speed, 3
// underspeed.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct SpindleMonitor {
    In<bool> is_on;
    In<double> command, feedback;
    Out<bool> at_speed, underspeed;
    ParamRw<std::uint32_t> level;
    ParamRw<double> threshold;

    void declare(Declare &d) noexcept {
        d.pin(is_on, "spindle-is-on");
        d.pin(command, "spindle-command");
        d.pin(feedback, "spindle-feedback");
        d.pin(at_speed, "spindle-at-speed");
        d.pin(underspeed, "spindle-underspeed");
        d.param(level, "level");
        d.param(threshold, "threshold");
        d.function<&SpindleMonitor::update>(this);
    }

    void update() noexcept {
        level = next_level();
        at_speed = level >= 2;
        underspeed = level == 3;
    }

  private:
    std::uint32_t next_level() const noexcept {
        if (!is_on) {
            return 0;
        }
        const double wanted = command;
        const double turning = feedback;
        const double missing = std::fabs(wanted) - turning * std::copysign(1.0, wanted);
        const bool near = std::fabs(wanted - turning) < threshold;
        const bool slow = !(missing <= threshold);  // true for NaN
        switch (level) {
        case 0: return 1;
        case 1: return near ? 2 : 1;
        case 2: return slow ? 3 : 2;
        default: return 3;
        }
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::SpindleMonitor, "spindle_monitor", mw::sdk::MANY);
