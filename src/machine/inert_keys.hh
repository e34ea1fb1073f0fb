// SPDX-License-Identifier: GPL-2.0-or-later
// Keys that INI files of such machines have and that `millwright run` does not act on, with the reason.
#pragma once

#include "config/ini_reader.hh"

namespace mw::machine {

/// Declares them, so that report_unknown() says each one that is set. Values that ask for what happens anyway
/// are passed over.
void know_inert_keys(config::IniReader &reader);

}  // namespace mw::machine
