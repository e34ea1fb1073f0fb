// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the parts of a component's C source that create its instances.
#pragma once

#include <string>

#include "hal/halcompile/component.hh"

namespace mw::halcompile {

/// count=, names=, personality= and the modparams.
std::string emit_module_parameters(const Component &component, int personalities);
/// rtapi_app_main and rtapi_app_exit.
std::string emit_app(const Component &component, const std::string &prefix);
/// main() of a userspace component.
std::string emit_main(const Component &component);

}  // namespace mw::halcompile
