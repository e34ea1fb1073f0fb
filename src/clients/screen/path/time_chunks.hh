// SPDX-License-Identifier: GPL-2.0-or-later
// The duration of a program, move by move, as the bytes of /api/times.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mw::screen {

/// A position where time is lost compared with the feed.
struct SlowSpot {
    std::string file;
    bool in_program = true;  ///< not in another file
    int line = 0;
    double lost_s = 0;
    std::string reason;
};

/// Overrides of the operator: 1 is as programmed; max_velocity in machine units per second, 0: none.
struct TimeOverrides {
    double feed = 1, rapid = 1, max_velocity = 0;
};

struct TimeSum {
    double total_s = 0, cutting_s = 0, rapid_s = 0, dwell_s = 0;
    bool isComplete = true;
    std::vector<SlowSpot> slowest;
};

/// All calls come from one thread.
class TimeChunks {
  public:
    static constexpr std::size_t MOVES_PER_CHUNK = 16384;

    /// `push` takes a chunk; false if the reader has left.
    explicit TimeChunks(std::function<bool(std::string)> push) : push_(std::move(push)) {}

    /// `point`: number of the last point of the path that belongs to the move, as counted by PathChunks.
    void move(std::uint32_t point, std::uint32_t line, double seconds, double speed);
    void error(std::string_view text);
    /// Sends the rest and the sums.
    void end(const TimeSum &sum);

  private:
    struct Move {
        std::uint32_t point = 0, line = 0;
        float seconds = 0, speed = 0;
    };
    void send();

    std::function<bool(std::string)> push_;
    std::vector<Move> moves_;
    bool is_read_ = true;
};

}  // namespace mw::screen
