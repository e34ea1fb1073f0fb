// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/path/time_chunks.hh"

#include <utility>

#include "clients/screen/documents.hh"
#include "clients/screen/path/detail/chunk.hh"

namespace mw::screen {

void TimeChunks::move(std::uint32_t point, std::uint32_t line, double seconds, double speed) {
    moves_.push_back({point, line, static_cast<float>(seconds), static_cast<float>(speed)});
    if (moves_.size() >= MOVES_PER_CHUNK) {
        send();
    }
}

void TimeChunks::send() {
    if (moves_.empty() || !is_read_) {
        return;
    }
    std::string body;
    detail::append(body, static_cast<std::uint32_t>(moves_.size()));
    for (const Move &move : moves_) {
        detail::append(body, move.point);
        detail::append(body, move.line);
        detail::append(body, move.seconds);
        detail::append(body, move.speed);
    }
    moves_.clear();
    is_read_ = push_(detail::chunk(detail::Chunk::TIMES, std::move(body), '\0'));
}

void TimeChunks::error(std::string_view text) {
    if (is_read_) {
        is_read_ = push_(detail::chunk(detail::Chunk::ERROR, std::string(text), ' '));
    }
}

void TimeChunks::end(const TimeSum &sum) {
    send();
    if (is_read_) {
        is_read_ = push_(detail::chunk(detail::Chunk::TIME_SUM, time_sum_document(sum), ' '));
    }
}

}  // namespace mw::screen
