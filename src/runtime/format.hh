// SPDX-License-Identifier: GPL-2.0-or-later
// Formatting as by printf without the library: no allocation, no locale, no locks. [any thread,
// realtime-safe]
#pragma once

#include <cstdarg>
#include <cstddef>

namespace mw::runtime {

/// Writes at most size-1 characters and a zero (nothing when size is 0); returns the length of the whole
/// text. Understands flags "-+ #0", width, precision, "*", lengths hh h l ll j z t L, conversions d i u o x X
/// c s p f F e E g G a A %. Anything else is copied unchanged. A floating-point number is cut at 400
/// characters.
int format_text(char *buffer, std::size_t size, const char *format, std::va_list args) noexcept;

}  // namespace mw::runtime
