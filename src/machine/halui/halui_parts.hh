// SPDX-License-Identifier: GPL-2.0-or-later
// Pins of halui, and the code that turns them into commands.
#pragma once

#include <array>

#include "hal/core/user_pin_set.hh"
#include "machine/halui/dial.hh"
#include "machine/halui/edge.hh"
#include "machine/halui/jog_pins.hh"
#include "machine/halui/pin_tables.hh"
#include "messages/client/client.hh"

namespace mw::halui {

/// An input pin for one command. `number` is its instance, or SELECTED.
struct HaluiButton {
    hal::UserPin<bool> pin;
    messages::Command (*make)(int number) = nullptr;
    int number = 0;
    bool wasOn = false;
};
inline constexpr int SELECTED = -1;  ///< the selected joint
template <const auto &TABLE>
struct Jogged {
    hal::UserPinSet<TABLE> pins;
    JogPins jog;
    client::Serial order = 0;  ///< the last jog command
    Edge select;
};
template <const auto &TABLE>
struct Turned {
    hal::UserPinSet<TABLE> pins;
    Dial dial;
    client::Serial order = 0;
};
struct SpindlePins {
    hal::UserPinSet<pins::SPINDLE_SPEED> speed;
    std::array<Edge, 5> edges;
    Turned<pins::SPINDLE_DIAL> override_dial;
    hal::UserPinSet<pins::SPINDLE_LAMPS> lamps;
};

}  // namespace mw::halui
