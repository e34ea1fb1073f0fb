// SPDX-License-Identifier: GPL-2.0-or-later
// Passes the machine's values from the thread that reads the machine to the thread of the broker.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "clients/publish/readings.hh"
#include "clients/publish/sparkplug/data_log.hh"

namespace mw::publish {

/// A metric as described in the birth.
struct Definition {
    std::string name;
    DataType type = DataType::DOUBLE;
    std::string unit;
};

/// All values at one moment. Records beginning with `next` change them.
struct Picture {
    bool isAlive = false;          ///< the machine is running
    std::uint64_t generation = 0;  ///< counts new sets of metrics, and restarts of the machine
    std::vector<Definition> definitions;
    std::vector<Value> values;
    std::vector<TimeMs> times;  ///< times of the values
    RecordId next = 1;
    std::uint64_t dropped = 0;
};

/// Any thread. A change is in the log before add() returns. Times of records increase strictly, also after a
/// restart of the process or when the clock is set back. So metric and time are a unique key of a value.
class LiveData {
  public:
    explicit LiveData(DataLog log);

    // --- for the thread that reads the machine

    /// Called when the machine is running, with these values.
    void born(const std::vector<Metric> &metrics, std::vector<Value> values, TimeMs now);
    void add(const std::vector<Change> &changes, TimeMs now);
    void gone();
    /// Difference between the times of new values and a clock that was set back [ms].
    TimeMs ahead_ms(TimeMs now) const;
    /// Makes the log durable. Returns the reason why the newest record is not on the disk; empty if it is.
    std::string sync();

    // --- for the thread of the broker

    Picture picture() const;
    /// The part of the picture that determines the next action.
    struct State {
        bool isAlive = false;
        std::uint64_t generation = 0;
        RecordId next = 1, confirmed = 1;
        std::uint64_t dropped = 0;
    };
    State state() const;
    std::vector<Record> read(RecordId from, std::size_t most) const;
    void confirm(RecordId end);

  private:
    TimeMs next_time(TimeMs now);
    void append(const std::vector<Change> &changes, TimeMs at);

    mutable std::mutex mutex_;
    DataLog log_;
    Picture picture_;
    TimeMs last_ = 0;
};

}  // namespace mw::publish
