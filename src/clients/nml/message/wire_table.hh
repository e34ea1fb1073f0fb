// SPDX-License-Identifier: GPL-2.0-or-later
// The messages of LinuxCNC's NML vocabulary: number and name on the wire, and the machine's command or the
// reason why it rejects the message (F8).
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "clients/nml/message/vocabulary.hh"

namespace mw::nml {

/// All rows in the order of their numbers.
std::span<const MessageKind> wire_messages();

/// For instance "EMC_TASK_SET_STATE_TYPE" for SetState. The declaration's own name if LinuxCNC has no such
/// message.
std::string_view wire_name(const messages::Declaration &declaration);

/// docs/reference/nml_messages.md.
std::string nml_reference_page();

}  // namespace mw::nml
