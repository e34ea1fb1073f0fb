// SPDX-License-Identifier: GPL-2.0-or-later
// Capabilities of this process: man 7 capabilities. Numbers are those of linux/capability.h.
#pragma once

#include <cstdint>

namespace mw {

/// Bit per capability.
std::uint64_t effective_capabilities();

/// Makes those effective that the program file permits (setcap ...+p). A file that made them effective by
/// itself (+ep) could not be started where a container lacks one of them.
void use_permitted_capabilities();

/// This process and what it starts have the capability no more.
void give_up_capability(int capability);

}  // namespace mw
