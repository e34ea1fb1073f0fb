// SPDX-License-Identifier: GPL-2.0-or-later
// Checks for components that are syntactically correct but cannot work.
#pragma once

#include "base/diagnostics/sink.hh"
#include "hal/halcompile/component.hh"

namespace mw::halcompile {

/// Reports errors in a component that is to be compiled from `base_name`.comp.
void check(const Component &component, const std::string &base_name, diagnostics::Sink &sink);

}  // namespace mw::halcompile
