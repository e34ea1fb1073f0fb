// SPDX-License-Identifier: GPL-2.0-or-later
// The texts that [DISPLAY]MESSAGE_... and MULTIMESSAGE_... put to the operator.
#pragma once

#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/screen/dialogs.hh"

namespace mw::programs {

/// In their order. What has no text, type or pin is told as an error in `sink`, with its place, and left out.
std::vector<screen::DialogFacts> dialog_facts(const ini::IniFile &ini, diagnostics::Sink &sink);

}  // namespace mw::programs
