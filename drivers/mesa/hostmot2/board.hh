// SPDX-License-Identifier: GPL-2.0-or-later
// A board with HostMot2 firmware: its modules, its pins, and the registers that a cycle reads and writes.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/mesa/hostmot2/modules/ioport.hh"
#include "drivers/mesa/hostmot2/modules/watchdog.hh"

namespace mw::mesa {

/// Reason why the positions that a board reports are no longer those of the machine.
enum class PositionLoss : std::uint8_t {
    NONE,
    BITTEN,     ///< step generators continued while the watchdog had turned their pins off
    STOPPED,    ///< there is no traffic, so the driver does not follow the board
    RETURNED,   ///< first read after STOPPED; joints that were homed in the meantime are not homed
    RESTARTED,  ///< the board has lost its counters
};

/// Events of a board for messages. Each event is true once.
struct BoardEvents {
    bool bitten = false;              ///< the watchdog has turned the outputs off
    std::int64_t longest_gap_ns = 0;  ///< longest time between two writes before the bite
    int failed_reads = 0;             ///< number of consecutive failed reads before the bite
    bool timeout_short = false;       ///< the time of the watchdog is less than 1.5 periods
    bool dump_requested = false;      ///< a user requests the output of describe() in the log
};

class Board {
  public:
    /// Selects the modules of a firmware by the configuration, and fixes the lists of the bus. Writes only to
    /// smart serial, to find its cards. [while loading]
    static Result<std::unique_ptr<Board>> make(RegisterBus &bus, const Idrom &idrom, const Config &config);

    /// Creates all pins and parameters. [while loading]
    void declare(PinSpace &space);
    /// Serial interfaces for other components. [while loading]
    Ports ports();
    /// Warnings about omitted modules. [while loading]
    const std::vector<std::string> &warnings() const noexcept { return assignment_.warnings; }
    const Assignment &assignment() const noexcept { return assignment_; }

    /// True if there are encoders that trigger_encoders() starts. [while loading]
    bool hasTriggers() const noexcept;
    /// Starts the transfers of absolute encoders with the next write. [servo thread]
    void trigger_encoders() noexcept;
    /// True if read_gpio() and write_gpio() may be used. [while loading]
    bool hasFastGpio() const noexcept { return ports_ != nullptr && bus_.hasImmediateAccess(); }
    /// Read and write the general pins immediately. Nothing is written before the first write of a cycle,
    /// while the watchdog has bitten, or while the bus is stopped. [one realtime thread, also a faster one]
    void read_gpio() noexcept;
    void write_gpio() noexcept;
    /// Sends the request of this cycle early. [servo thread]
    void request() noexcept { bus_.request(); }
    /// Reads all registers; after a failure all pins keep their values. `now_ns` is of the same clock as in
    /// write(). [servo thread]
    void read(long period_ns, std::int64_t now_ns) noexcept;
    /// Writes the due registers. Nothing is written before a successful read, or while the watchdog has
    /// bitten. `now_ns` is of any clock; it measures the time between writes. [servo thread]
    void write(long period_ns, std::int64_t now_ns) noexcept;
    /// Reports whether the last read() has shown that positions are lost. [servo thread]
    PositionLoss take_position_loss() noexcept { return std::exchange(loss_, PositionLoss::NONE); }
    /// Events since the last call. [servo thread]
    BoardEvents take_events() noexcept;
    /// Writes a message of a module to `text`; returns its length, or 0. [servo thread]
    std::size_t take_message(std::span<char> text) noexcept;

    /// Writes line `line` of the state of the board: modules, then registers with their last written values.
    /// False: there are no more lines. [servo thread]
    bool describe(int line, std::span<char> text) const noexcept;

    std::int64_t timeout_ns() const noexcept { return checked_timeout_ns_; }

    /// Makes the watchdog bite at once, so that all outputs are off. No effect if this driver has written
    /// nothing, because another host may control the board. [while unloading]
    void stop() noexcept;

  private:
    Board(RegisterBus &bus, Assignment assignment) : bus_(bus), assignment_(std::move(assignment)) {}
    void add(const Idrom &idrom, const Config &config, const UsedModule &module);
    PositionLoss find_loss(CycleRead result, bool bitten, bool restarted) noexcept;
    bool isReadRecent(std::int64_t now_ns) const noexcept;
    void note_write(std::int64_t now_ns) noexcept;
    void note_timeout(long period_ns) noexcept;

    RegisterBus &bus_;
    Assignment assignment_;
    Registers registers_;
    std::vector<std::unique_ptr<Module>> modules_;
    IoPorts *ports_ = nullptr;      ///< in modules_
    Watchdog *watchdog_ = nullptr;  ///< in modules_; null: the firmware has none
    PositionLoss loss_ = PositionLoss::NONE;
    bool followed_ = false;     ///< the positions of the board are valid
    bool was_stopped_ = false;  ///< there was no traffic since the last successful read
    bool restarted_ = false;    ///< the board has restarted since the last successful read
    bool fresh_ = false, is_read_once_ = false, stopped_ = false, rewrite_due_ = true;
    bool write_doubtful_ = true;  ///< true after a write since the last successful read
    std::int64_t last_write_ns_ = 0, read_ns_ = 0, longest_gap_ns_ = 0, checked_timeout_ns_ = 0;
    bool written_ = false;
    std::atomic<bool> output_on_ = false;  ///< the last cycle has written; read by a faster thread
    int failed_reads_ = 0;
    BoardEvents events_;
};

}  // namespace mw::mesa
