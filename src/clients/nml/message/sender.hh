// SPDX-License-Identifier: GPL-2.0-or-later
// Who sends each message (F8), and the page that says so.
#pragma once

#include <string>

#include "messages/declarations/describe.hh"

namespace mw::nml {

enum class Sender {
    OPERATOR,     ///< screens, panels and other programs
    INTERPRETER,  ///< for a word of G-code; an operator gives it as G-code
    START,        ///< what a machine is made from and how it ends: the INI file says it
    STATUS,       ///< the machine, to all who listen
};

/// Of every numbered command and status of src/messages/declarations.
Sender sender_of(const messages::Declaration &declaration);

/// docs/reference/nml_messages.md.
std::string nml_reference_page();

}  // namespace mw::nml
