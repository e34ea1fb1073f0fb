// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/path/time_chunks.hh"

#include <utility>

#include "clients/screen/http/json_text.hh"
#include "clients/screen/path/detail/chunk.hh"

namespace mw::screen {
namespace {

std::string time_sum_document(const TimeSum &sum) {
    Json slowest = Json::array();
    for (const SlowSpot &spot : sum.slowest) {
        slowest.push_back({{"file", spot.file},
                           {"is_in_program", spot.in_program},
                           {"line", spot.line},
                           {"lost_s", spot.lost_s},
                           {"reason", spot.reason}});
    }
    return text_of(Json{{"total_s", sum.total_s},
                        {"cutting_s", sum.cutting_s},
                        {"rapid_s", sum.rapid_s},
                        {"dwell_s", sum.dwell_s},
                        {"is_complete", sum.isComplete},
                        {"slowest", std::move(slowest)}});
}

}  // namespace

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
