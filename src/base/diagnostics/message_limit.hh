// SPDX-License-Identifier: GPL-2.0-or-later
#pragma once

#include <cstddef>

namespace mw::diagnostics {

/// Readers of files stop after this number of errors and warnings: a file may have millions of wrong lines.
inline constexpr std::size_t MOST_OF_A_FILE = 100;

}  // namespace mw::diagnostics
