// SPDX-License-Identifier: GPL-2.0-or-later
// A board with HostMot2 firmware: its modules, its pins, and what a cycle reads and writes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "drivers/mesa/hostmot2/modules/watchdog.hh"

namespace mw::mesa {

/// What happened to a board, for messages. Each is true once.
struct BoardEvents {
    bool hasBitten = false;           ///< the watchdog has turned the outputs off
    std::int64_t longest_gap_ns = 0;  ///< the longest time between two writes before it
    int failed_reads = 0;             ///< reads in a row that failed before it
    bool isTimeoutShort = false;      ///< the time of the watchdog is less than 1.5 periods
};

class Board {
  public:
    /// Uses the modules of a firmware as the configuration says, and fixes the lists of the bus. Only smart
    /// serial is written to, to find its cards. [while loading]
    static Result<std::unique_ptr<Board>> make(RegisterBus &bus, const Idrom &idrom, const Config &config);

    /// Makes all pins and parameters. [while loading]
    void declare(PinSpace &space);
    /// Modules that are left out. [while loading]
    const std::vector<std::string> &warnings() const noexcept { return assignment_.warnings; }
    const Assignment &assignment() const noexcept { return assignment_; }

    /// Sends the request of this cycle early. [servo thread]
    void request() noexcept { bus_.request(); }
    /// Reads all registers; after a failure all pins keep their values. `now_ns` of the same clock as in
    /// write(); 0: one period after the last write. [servo thread]
    void read(long period_ns, std::int64_t now_ns = 0) noexcept;
    /// Writes what is due. Nothing is written before a read succeeded, nor while the watchdog has bitten.
    /// `now_ns` of any clock measures the time between writes. [servo thread]
    void write(long period_ns, std::int64_t now_ns) noexcept;
    /// What happened since the last call. [servo thread]
    BoardEvents take_events() noexcept;
    /// A message of a module into `text`: its length, or 0. [servo thread]
    std::size_t take_message(std::span<char> text) noexcept;

    std::int64_t timeout_ns() const noexcept { return checked_timeout_ns_; }

    /// Lets the watchdog bite at once, so that all outputs are off. [while unloading]
    void stop() noexcept;

  private:
    Board(RegisterBus &bus, Assignment assignment) : bus_(bus), assignment_(std::move(assignment)) {}
    void add(const Idrom &idrom, const Config &config, const UsedModule &module);
    void note_write(std::int64_t now_ns) noexcept;
    void note_timeout(long period_ns) noexcept;

    RegisterBus &bus_;
    Assignment assignment_;
    Registers registers_;
    std::vector<std::unique_ptr<Module>> modules_;
    Watchdog *watchdog_ = nullptr;  ///< in modules_; null: the firmware has none
    bool isFresh_ = false, isReadOnce_ = false, isStopped_ = false, isRewriteDue_ = true;
    bool isWriteDoubtful_ = true;  ///< since the last read that succeeded
    std::int64_t last_write_ns_ = 0, longest_gap_ns_ = 0, checked_timeout_ns_ = 0;
    bool hasWritten_ = false;
    int failed_reads_ = 0;
    BoardEvents events_;
};

}  // namespace mw::mesa
