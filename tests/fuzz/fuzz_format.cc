// SPDX-License-Identifier: GPL-2.0-or-later
// Formats any text: each line remains one line, and formatting twice changes nothing. Explains its first
// line.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "gcode/analysis/explain.hh"
#include "gcode/analysis/format.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string text(reinterpret_cast<const char *>(data), size);
    const std::string once = mw::gcode::format_program(text);
    const bool isSettled = mw::gcode::format_program(once) == once;
    const bool hasAllLines =
        std::count(once.begin(), once.end(), '\n') == std::count(text.begin(), text.end(), '\n');
    if (!isSettled || !hasAllLines) {
        std::abort();
    }
    (void)mw::gcode::explain_line(text.substr(0, text.find('\n')), "F100");
    return 0;
}
