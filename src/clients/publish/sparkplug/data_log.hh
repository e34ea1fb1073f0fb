// SPDX-License-Identifier: GPL-2.0-or-later
// Records on disk that are stored until they are confirmed. Published values wait here while no broker
// accepts them.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

namespace mw::publish {

/// Number of a record. Consecutive and never reused.
using RecordId = std::uint64_t;

struct LogLimits {
    std::uint64_t bytes = 64UL << 20U;  ///< total size of all files; the oldest file is dropped when it is
                                        ///< exceeded
    std::uint64_t segment_bytes = 1UL << 20U;  ///< size of one file
};

struct Record {
    RecordId id = 0;
    std::string bytes;
};

/// Files of records in a folder that one process uses at a time. A record is written by one call before
/// append() returns, so a killed process loses no record. After a power cut the log ends before the first
/// damaged record. One thread at a time.
class DataLog {
  public:
    /// Opens the log; creates the folder if it is missing.
    static Result<DataLog> open(const std::string &folder, const LogLimits &limits = {});
    DataLog(DataLog &&other) noexcept;
    DataLog &operator=(DataLog &&other) noexcept;
    ~DataLog();

    /// Appends a record. If the disk does not accept it, it is stored in memory, among the newest
    /// MOST_IN_MEMORY records.
    RecordId append(std::string bytes);
    /// Number of the next record.
    RecordId next_id() const { return next_; }
    /// Stored records beginning with `from`, at most `most`.
    std::vector<Record> read(RecordId from, std::size_t most) const;

    /// The newest record, also if it is confirmed; empty if there is none.
    std::string newest() const;

    /// Records before `end` are no longer needed.
    void confirm(RecordId end);
    /// The first record that is not confirmed.
    RecordId confirmed() const { return confirmed_; }
    /// Number of records dropped before they were confirmed, since the log was opened.
    std::uint64_t dropped() const { return dropped_; }
    /// The reason why the last record is not on the disk; empty if it is.
    const std::string &trouble() const { return trouble_; }
    /// Number of damaged records found at the start.
    std::uint64_t damaged() const { return damaged_; }
    /// Makes all records durable. [blocks]
    void sync();

    static constexpr std::size_t MOST_IN_MEMORY = 4096;

  private:
    struct Segment {
        std::string path;
        RecordId first = 0;
        std::vector<std::uint32_t> starts;  ///< offset of each record in the file [bytes]
        std::uint64_t bytes = 0;
    };

    DataLog(std::string folder, const LogLimits &limits, int lock)
        : folder_(std::move(folder)), limits_(limits), lock_(lock) {}
    Result<> load();
    Result<> load_segment(const std::string &path, RecordId first);
    void load_confirmed();
    bool write(const Record &record);
    bool begin_segment(RecordId first);
    void drop_old();
    void drop_front();
    void close();
    const Record *in_memory(RecordId id) const;
    std::string from_disk(RecordId id) const;

    std::string folder_;
    LogLimits limits_;
    int lock_ = -1, file_ = -1, confirmed_file_ = -1;
    std::deque<Segment> segments_;
    std::deque<Record> memory_;  ///< the newest records
    RecordId next_ = 1, confirmed_ = 1;
    std::uint64_t dropped_ = 0, damaged_ = 0, bytes_ = 0;
    bool isUnsynced_ = false;
    std::string trouble_;
};

}  // namespace mw::publish
