// SPDX-License-Identifier: GPL-2.0-or-later
// The record of a board's cycles as a file in shared memory. It outlives the process that drives the board
// and remains until the computer is restarted or the board is loaded again.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.hh"
#include "drivers/mesa/ethernet/cycle_ring.hh"

namespace mw::mesa {

/// A record that this process writes.
class CycleRecordFile {
  public:
    /// Replaces the file of a board such as hm2_7i76e.0; `address` is stored for readers. [while loading]
    static Result<CycleRecordFile> create(const std::string &board, const std::string &address);

    CycleRecord &record() const noexcept { return *record_; }

  private:
    struct Unmap {
        void operator()(CycleRecord *record) const noexcept;
    };
    explicit CycleRecordFile(CycleRecord *record) : record_(record) {}

    std::unique_ptr<CycleRecord, Unmap> record_;
};

/// The cycles of a board, oldest first.
struct RecordedCycles {
    std::string board, address;
    std::int64_t period_ns = 0;
    BoardFault fault = BoardFault::NONE;
    std::int64_t fault_ns = 0;         ///< monotonic
    std::vector<CycleTimes> at_fault;  ///< up to the fault; empty: there was none
    std::vector<CycleTimes> since;     ///< after the fault, or all
};

/// The files of this user.
std::vector<std::string> find_cycle_records();
/// Copies a file. If the driver writes in this time, changed records are omitted.
Result<RecordedCycles> read_cycle_record(const std::string &path);

}  // namespace mw::mesa
