// SPDX-License-Identifier: GPL-2.0-or-later
// Maximum sizes of fixed layouts (shared memory, pins).
#pragma once

namespace mw {

inline constexpr int MAX_JOINTS = 16;
inline constexpr int MAX_AXES = 9;
inline constexpr int MAX_SPINDLES = 8;
inline constexpr int MAX_DIGITAL_IO = 64;
inline constexpr int MAX_ANALOG_IO = 64;

}  // namespace mw
