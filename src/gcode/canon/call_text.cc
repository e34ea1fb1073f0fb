// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/canon/call_text.hh"

#include <array>

#include "base/text.hh"

namespace mw::gcode {

void append_argument(std::string &text, double value) {
    std::array<char, FIXED4_SIZE> digits;  // initialised only when used
    text.append(digits.data(), write_fixed4(digits, value));
}

void append_argument(std::string &text, int value) {
    text += std::to_string(value);
}

void append_argument(std::string &text, const Pose &pose) {
    for (int axis = 0; axis < geometry::AXIS_U; ++axis) {
        text += axis > 0 ? ", " : "";
        append_argument(text, pose[axis]);
    }
}

void append_argument(std::string &text, const std::string &value) {
    text.append(1, '"').append(value).append(1, '"');
}

}  // namespace mw::gcode
