// SPDX-License-Identifier: GPL-2.0-or-later
// Capabilities of this process: man 7 capabilities. Numbers are those of linux/capability.h.
#pragma once

#include <cstdint>

namespace mw {

/// The effective capabilities of this process, bit per capability.
std::uint64_t effective_capabilities();

/// Makes the permitted capabilities of the program file (setcap ...+p) effective. With a file that makes them
/// effective itself (+ep) the program would not start in a container that lacks one of them.
void use_permitted_capabilities();

/// Removes the capability from this process and the processes that it starts.
void give_up_capability(int capability);

}  // namespace mw
