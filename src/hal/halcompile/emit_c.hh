// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the C source of a component. Order: framework, macros for pins, parameters and variables, then the
// component's own code. So no pin name can change the framework.
#pragma once

#include <string>

#include "hal/halcompile/component.hh"

namespace mw::halcompile {

inline constexpr int DEFAULT_PERSONALITIES = 64;

/// The C source of a checked component. `personalities`: maximum number of values of personality=.
std::string emit_c(const Component &component, int personalities = DEFAULT_PERSONALITIES);

}  // namespace mw::halcompile
