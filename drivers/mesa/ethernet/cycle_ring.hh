// SPDX-License-Identifier: GPL-2.0-or-later
// The last cycles of a board with their times, which show who was late: the thread, the kernel, the network
// or the board.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace mw::mesa {

/// How a cycle has ended.
enum class CycleOutcome : std::uint8_t {
    DONE,
    NO_ANSWER,    ///< nothing came before the deadline
    SEND_FAILED,  ///< the kernel did not accept the request; `error` says why
    RECEIVE_FAILED,
    SHORT_ANSWER,  ///< an answer of the wrong size
    WRITE_LOST,    ///< the answer came, but the board has not had the last write
    OTHER_BOARD,   ///< after a fault: the board that answers is not the one that was loaded
};

/// Times are monotonic [ns]; 0: it did not happen.
struct CycleTimes {
    std::int64_t begin_ns = 0;     ///< the thread began its cycle
    std::int64_t sent_ns = 0;      ///< the request was handed to the kernel
    std::int64_t answered_ns = 0;  ///< the answer was there
    std::int64_t written_ns = 0;   ///< the write packet was handed to the kernel
    std::uint32_t number = 0;      ///< of the request
    std::int32_t error = 0;        ///< errno
    std::uint16_t stale = 0;       ///< older answers that came meanwhile
    CycleOutcome outcome = CycleOutcome::DONE;
};

/// Keeps the last SIZE cycles. [servo thread]
class CycleRing {
  public:
    static constexpr std::size_t SIZE = 10'000;

    /// The record of a new cycle, which overwrites the oldest.
    CycleTimes &next() noexcept {
        ++count_;
        CycleTimes &cycle = cycles_[(count_ - 1) % SIZE];
        cycle = {};
        return cycle;
    }
    /// The record of the cycle `age` cycles ago; 0: the last one. `age` is below size().
    const CycleTimes &at(std::size_t age) const noexcept { return cycles_[(count_ - 1 - age) % SIZE]; }
    CycleTimes &last() noexcept { return cycles_[(count_ - 1) % SIZE]; }
    std::size_t size() const noexcept { return count_ < SIZE ? count_ : SIZE; }

  private:
    std::array<CycleTimes, SIZE> cycles_{};
    std::size_t count_ = 0;
};

}  // namespace mw::mesa
