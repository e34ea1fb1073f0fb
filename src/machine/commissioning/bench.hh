// SPDX-License-Identifier: GPL-2.0-or-later
// The functions of a machine that commissioning needs. The machine moves by its own controller, with all its
// checks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::commissioning {

struct JointReading {
    double command = 0, feedback = 0;  ///< state in the controller
    bool isHomeSwitchOn = false;       ///< as the controller sees it
    bool isMoving = false, isHoming = false, isHomed = false;
    bool isDriveFaulted = false, isFollowingErrorTripped = false;
};

/// All calls come from one thread. Requests are asynchronous; readings of later cycles show their effect.
class Bench {
  public:
    virtual ~Bench() = default;

    virtual double now_s() const = 0;
    virtual bool isOn() const = 0;
    virtual bool isEstopReleased() const = 0;
    virtual bool isProbeOn() const = 0;
    virtual JointReading joint(int joint) const = 0;
    /// Number of late cycles of the servo thread.
    virtual std::uint64_t late_cycles() const = 0;
    /// Maximum wake-up latency of a realtime thread since the start [s].
    virtual double worst_latency_s() const = 0;
    /// The reported reason why the machine went off; empty if it did not.
    virtual std::string last_error() const = 0;

    /// Switches the machine on with the drives of these joints only.
    virtual void switch_on(const std::vector<int> &joints) = 0;
    /// Stops axes and spindle, and cancels a switch-on that is under way.
    virtual void switch_off() = 0;
    /// Moves a joint to a position; repeating the request has no effect.
    virtual void move_to(int joint, double position, double speed) = 0;
    virtual void stop(int joint) = 0;
    virtual void home(int joint) = 0;
    /// Unhomes a joint; its soft limits then no longer apply.
    virtual void unhome(int joint) = 0;
    virtual void run_spindle(double speed_rpm) = 0;
    virtual void stop_spindle() = 0;

    /// Value of a HAL pin or parameter; nothing if it does not exist.
    virtual std::optional<double> value(std::string_view name) const = 0;
    /// Sets a pin or parameter. If this fails the machine is switched off, with a last_error().
    virtual void set_value(std::string_view name, double value) = 0;

    static constexpr int EVERY_JOINT = -1, NO_JOINT = -2;
};

}  // namespace mw::commissioning
