// SPDX-License-Identifier: GPL-2.0-or-later
// The last cycles of a board with their times, which show whether the thread, the kernel, the network or the
// board was late. Another process can read this memory, also after the driver has ended.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace mw::mesa {

/// Result of a cycle.
enum class CycleOutcome : std::uint8_t {
    DONE,
    NO_ANSWER,    ///< no answer before the deadline
    SEND_FAILED,  ///< the kernel did not accept the request; the reason is in `error`
    RECEIVE_FAILED,
    SHORT_ANSWER,  ///< an answer of the wrong size
    WRITE_LOST,    ///< the answer arrived, but the board has not received the last write
    OTHER_BOARD,   ///< after a fault: the board is not the one at loading
};

/// Monotonic times [ns]; 0: the event did not happen.
struct CycleTimes {
    std::int64_t begin_ns = 0;     ///< the thread began its cycle
    std::int64_t sent_ns = 0;      ///< the request was passed to the kernel
    std::int64_t answered_ns = 0;  ///< the answer arrived
    std::int64_t written_ns = 0;   ///< the write packet was passed to the kernel
    std::uint32_t number = 0;      ///< number of the request
    std::int32_t error = 0;        ///< errno
    std::uint16_t stale = 0;       ///< older answers that arrived before it
    /// Packets that the host has sent, this request included, and packets that the board has received (0
    /// without an answer). Both counters wrap.
    std::uint16_t host_packets = 0, board_packets = 0;
    CycleOutcome outcome = CycleOutcome::DONE;
};

/// Stores the last SIZE cycles. [one writer]
class CycleRing {
  public:
    static constexpr std::size_t SIZE = 10'000;

    /// The record of a new cycle, which overwrites the oldest.
    CycleTimes &next() noexcept {
        const std::uint64_t count = count_.load(std::memory_order_relaxed);
        CycleTimes &cycle = cycles_[count % SIZE];
        cycle = {};
        count_.store(count + 1, std::memory_order_release);
        return cycle;
    }
    /// The record of the cycle `age` cycles ago; 0: the last one. `age` is below size().
    const CycleTimes &at(std::size_t age) const noexcept { return cycles_[(count() - 1 - age) % SIZE]; }
    std::size_t size() const noexcept { return count() < SIZE ? count() : SIZE; }
    /// Number of cycles since the beginning. Acquires the data written before it.
    std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
    void clear() noexcept { count_.store(0, std::memory_order_release); }

  private:
    std::array<CycleTimes, SIZE> cycles_{};
    std::atomic<std::uint64_t> count_{0};
};

/// Reason for keeping the cycles before an event.
enum class BoardFault : std::uint8_t {
    NONE,
    STOPPED,      ///< too many failures: the traffic was stopped
    OTHER_BOARD,  ///< another board answers
    WATCHDOG,     ///< the watchdog of the board has bitten
};

/// Data for finding the cause of a fault. Its layout is that of the file.
struct CycleRecord {
    static constexpr std::uint32_t MAGIC = 0x4D574359;  ///< "MWCY"
    static constexpr std::uint32_t LAYOUT = 1;

    std::uint32_t magic = MAGIC;
    std::uint32_t layout = LAYOUT;
    std::array<char, 48> board{};    ///< name in HAL, such as hm2_7i76e.0
    std::array<char, 48> address{};  ///< ADDRESS or ADDRESS:PORT
    std::atomic<std::int64_t> period_ns{0};
    std::atomic<std::uint32_t> current{
        0};  ///< ring that receives cycles; the other ring contains the cycles before the fault
    std::atomic<BoardFault> fault{BoardFault::NONE};
    std::atomic<std::int64_t> fault_ns{0};  ///< monotonic time
    std::array<CycleRing, 2> rings;
};

/// Writes a record. After a fault the cycles before it are kept, and the next cycles are written to the other
/// ring. A fault within SIZE cycles of the last one is still in that ring and keeps nothing. [servo thread]
class CycleLog {
  public:
    explicit CycleLog(CycleRecord &record) noexcept : record_(&record) {}

    CycleTimes &next() noexcept {
        last_ = &ring().next();
        return *last_;
    }
    /// The last cycle, also if a fault was kept after it; there must be one.
    CycleTimes &last() noexcept { return *last_; }
    const CycleTimes &last() const noexcept { return *last_; }
    bool isEmpty() const noexcept { return last_ == nullptr; }

    void set_period(std::int64_t period_ns) noexcept {
        record_->period_ns.store(period_ns, std::memory_order_relaxed);
    }
    void keep(BoardFault fault, std::int64_t now_ns) noexcept {
        const bool kept = record_->fault.load(std::memory_order_relaxed) != BoardFault::NONE;
        if (kept && ring().count() < CycleRing::SIZE) {
            return;
        }
        const std::uint32_t other = 1 - record_->current.load(std::memory_order_relaxed);
        record_->rings[other].clear();
        record_->fault_ns.store(now_ns, std::memory_order_relaxed);
        record_->fault.store(fault, std::memory_order_relaxed);
        record_->current.store(other, std::memory_order_release);
    }

  private:
    CycleRing &ring() noexcept { return record_->rings[record_->current.load(std::memory_order_relaxed)]; }

    CycleRecord *record_;
    CycleTimes *last_ = nullptr;
};

}  // namespace mw::mesa
