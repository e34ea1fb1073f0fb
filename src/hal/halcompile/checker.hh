// SPDX-License-Identifier: GPL-2.0-or-later
// What the grammar lets through but cannot work.
#pragma once

#include "base/diagnostics/sink.hh"
#include "hal/halcompile/component.hh"

namespace mw::halcompile {

/// Reports what is wrong with a component that is to be compiled from a file named `base_name`.comp.
void check(const Component &component, const std::string &base_name, diagnostics::Sink &sink);

}  // namespace mw::halcompile
