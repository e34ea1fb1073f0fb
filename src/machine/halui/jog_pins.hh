// SPDX-License-Identifier: GPL-2.0-or-later
// The pins that jog one joint or axis, as commands.
#pragma once

#include <cstdint>
#include <vector>

#include "machine/halui/edge.hh"
#include "machine/halui/pin_tables.hh"
#include "messages/declarations/command.hh"

namespace mw::halui {

/// A jog goes on while its pin says so, by a lease that is renewed: what has been stopped by anything else
/// does not begin again before the pin has been let go.
class JogPins {
  public:
    struct Target {
        bool isJoint = true;
        int index = 0;
    };
    /// Once a cycle; what is to be asked for. Another target ends the jog of the one before, and begins its
    /// own while the pins are true, unless something else has ended the jog before.
    std::vector<messages::Command> step(const JogInputs &now, const JogSettings &settings,
                                        const Target &target, std::int64_t now_ns);

    /// Task has refused the jog or its renewal.
    void note_refusal() { isRefused_ = true; }

  private:
    /// Part of the jog speed, with its sign, that the pins ask for; 0: none.
    static double part_of(const JogInputs &now, const JogSettings &settings);
    /// @param speed of the whole jog speed [units/s]
    void step_held(double part, double speed, std::int64_t now_ns, std::vector<messages::Command> &asked);

    Target target_;
    double part_ = 0;         ///< of the jog that was asked for
    bool isWaiting_ = false;  ///< until all pins are let go
    bool isRefused_ = false;  ///< the jog that was asked for
    bool isKnown_ = false;
    std::int64_t renewed_ns_ = 0;
    Edge plus_, minus_;
};

}  // namespace mw::halui
