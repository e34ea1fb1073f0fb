// SPDX-License-Identifier: GPL-2.0-or-later
// The texts that [DISPLAY]MESSAGE_... and MULTIMESSAGE_... put to the operator.
#pragma once

#include <vector>

#include "config/ini_file.hh"
#include "diag/sink.hh"
#include "ui/web/dialogs.hh"

namespace mw::app {

/// In their order. What has no text, type or pin is told as an error in `sink`, with its place, and left out.
std::vector<ui::web::DialogFacts> dialog_facts(const config::IniFile &ini, diag::Sink &sink);

}  // namespace mw::app
