// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/line_input.hh"

#include <utility>

#include "base/text.hh"

namespace mw::rsh {
namespace {

constexpr std::string_view LINE_ENDS("\r\n\0", 3);

}  // namespace

std::optional<LineInput::Line> LineInput::next() {
    while (true) {
        const std::size_t end = input_.find_first_of(LINE_ENDS);
        if (end == std::string::npos && (!isOver_ || input_.empty())) {
            if (input_.size() > MAX_LINE) {
                line_too_long_ = true;
                input_.clear();
            }
            return std::nullopt;
        }
        std::string line = input_.substr(0, end);
        input_.erase(0, end == std::string::npos ? end : end + 1);
        if (line.size() > MAX_LINE || std::exchange(line_too_long_, false)) {
            return Line{{}, true};
        }
        if (!trim(line).empty()) {
            return Line{std::move(line), false};
        }
    }
}

}  // namespace mw::rsh
