// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/rsh/shared_view.hh"

#include <algorithm>

namespace mw::rsh {
namespace {

std::size_t place_of(messages::MessageKind kind) {
    return static_cast<std::size_t>(kind) - static_cast<std::size_t>(messages::MessageKind::OPERATOR_ERROR);
}

}  // namespace

Result<> SharedView::read() {
    auto read = viewer_.read_status();
    // Messages are read for other clients, too, so a line counts as read only when a connection requests it.
    while (auto message = viewer_.next_message(client::Viewer::Reading::LOOKS_ON)) {
        lines_.push_back({++newest_, message->kind, std::move(message->text)});
        if (lines_.size() > MAX_LINES) {
            lines_.pop_front();
        }
    }
    return read;
}

std::optional<std::string> SharedView::next_line(messages::MessageKind kind, ReadUpTo &own) {
    const std::size_t place = place_of(kind);
    for (const Line &line : lines_) {
        if (line.kind == kind && line.number > own[place]) {
            own[place] = line.number;
            read_up_to_[place] = std::max(read_up_to_[place], line.number);
            return line.text;
        }
    }
    return std::nullopt;
}

}  // namespace mw::rsh
