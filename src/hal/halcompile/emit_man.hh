// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <string>

#include "hal/halcompile/component.hh"

namespace mw::halcompile {

/// The manual page of a component in troff, section 9 (userspace: 1). The component's own texts are troff
/// already.
std::string emit_man(const Component &component);

/// 9, or 1 for userspace components.
int man_section(const Component &component);

}  // namespace mw::halcompile
