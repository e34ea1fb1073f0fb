// SPDX-License-Identifier: GPL-2.0-or-later
// Settings of one connection.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "clients/rsh/shared_view.hh"
#include "messages/declarations/status.hh"

namespace mw::rsh {

/// Unit of lengths in answers. AUTO: the unit of the program.
enum class LengthUnit : std::uint8_t { AUTO, INCH, MM, CM, CUSTOM };
enum class AngleUnit : std::uint8_t { AUTO, DEG, RAD, GRAD, CUSTOM };

struct OwnState {
    bool greeted = false;    ///< HELLO was sent with the correct password
    bool isEnabled = false;  ///< may command the machine
    bool isEchoing = true;
    bool isVerbose = false;
    bool isTimed = false;          ///< each line of an answer begins with the time
    bool waiting_for_done = true;  ///< an answer to SET waits for the end of the command
    bool updating = true;          ///< GET reports the newest status
    double timeout_s = 0;          ///< timeout of SET; 0: none
    LengthUnit length_unit = LengthUnit::AUTO;
    AngleUnit angle_unit = AngleUnit::AUTO;
    std::string protocol = "1.1";
    ReadUpTo lines{};
    std::unique_ptr<messages::MachineStatus> kept;  ///< status for GET while it is not updated
};

}  // namespace mw::rsh
