// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the text of a .comp file. Errors go to the sink with their places; reading goes on at the next
// declaration.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "hal/halcompile/component.hh"

namespace mw::halcompile {

/// The declarations and the code of `text`; `file` is what places and #line directives name. What was wrong
/// is in the sink; the tree then holds what could be read.
Component parse(std::string_view text, const std::string &file, diagnostics::Sink &sink);

}  // namespace mw::halcompile
