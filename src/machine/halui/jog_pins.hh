// SPDX-License-Identifier: GPL-2.0-or-later
// The pins that jog one joint or axis, as commands.
#pragma once

#include <cstdint>
#include <vector>

#include "machine/halui/edge.hh"
#include "machine/halui/pin_tables.hh"
#include "messages/declarations/command.hh"

namespace mw::halui {

/// A jog continues while its pin is TRUE, by renewing its lease. If the jog was stopped for another reason,
/// it starts again only after the pin has been released.
class JogPins {
  public:
    struct Target {
        bool isJoint = true;
        int index = 0;
    };
    /// Called once in each cycle; returns the commands. Selecting another target ends the previous jog and
    /// starts a jog of the new target while the pins are TRUE, unless the previous jog was stopped for
    /// another reason.
    std::vector<messages::Command> step(const JogInputs &now, const JogSettings &settings,
                                        const Target &target, std::int64_t now_ns);

    /// Called when task has rejected the jog or its renewal.
    void note_refusal() { rejected_ = true; }

  private:
    /// Fraction of the jog speed, with sign, from the pins; 0: none.
    static double part_of(const JogInputs &now, const JogSettings &settings);
    /// @param speed full jog speed [units/s]
    void step_held(double part, double speed, std::int64_t now_ns, std::vector<messages::Command> &asked);

    Target target_;
    double part_ = 0;        ///< fraction of the jog speed of the current jog
    bool waiting_ = false;   ///< no jog until all pins are released
    bool rejected_ = false;  ///< the jog was rejected
    bool known_ = false;
    std::int64_t renewed_ns_ = 0;
    Edge plus_, minus_;
};

}  // namespace mw::halui
