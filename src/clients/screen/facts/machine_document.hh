// SPDX-License-Identifier: GPL-2.0-or-later
// The facts about the machine as JSON: /api/machine.
#pragma once

#include <string>

#include "clients/screen/facts/machine_facts.hh"

namespace mw::screen {

std::string machine_document(const MachineFacts &facts);

}  // namespace mw::screen
