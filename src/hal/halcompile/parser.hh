// SPDX-License-Identifier: GPL-2.0-or-later
// Parses the text of a .comp file. Errors go to the sink with their positions; reading continues at the next
// declaration.
#pragma once

#include <string>
#include <string_view>

#include "base/diagnostics/sink.hh"
#include "hal/halcompile/component.hh"

namespace mw::halcompile {

/// Parses the declarations and the code of `text`; `file` is the name for positions and #line directives.
/// Errors go to the sink; the tree has everything that could be read.
Component parse(std::string_view text, const std::string &file, diagnostics::Sink &sink);

}  // namespace mw::halcompile
