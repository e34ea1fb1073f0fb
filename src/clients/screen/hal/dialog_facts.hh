// SPDX-License-Identifier: GPL-2.0-or-later
// The texts of [DISPLAY]MESSAGE_... and MULTIMESSAGE_... for the operator.
#pragma once

#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "clients/screen/hal/dialogs.hh"

namespace mw::screen {

/// The messages in order. A message without text, type or pin is reported to `sink` as an error with its
/// position, and omitted.
std::vector<DialogFacts> dialog_facts(const ini::IniFile &ini, diagnostics::Sink &sink);

}  // namespace mw::screen
