// SPDX-License-Identifier: GPL-2.0-or-later
// Parameter files.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "gcode/interpreter/expressions/parameters.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    mw::gcode::detail::Parameters parameters;
    (void)parameters.parse({reinterpret_cast<const char *>(data), size}, "fuzz.var");
    return 0;
}
