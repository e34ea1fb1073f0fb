// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that wait to be run, in the order of execution.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::schedule {

/// A program, and settings before its start.
struct Job {
    int priority = 0;            ///< the lowest value is first; of equal ones the program added first
    int tag = 0;                 ///< its identifier; > 0
    double x = 0, y = 0, z = 0;  ///< origin in the first coordinate system, with zone 0 [program units]
    int zone = 0;                ///< 1 to 9: the origin is that of G54 to G59.3
    std::string file;
    double feed_percent = 100, spindle_percent = 100;  ///< overrides
    int tool = 0;                                      ///< 0: the tool in the spindle
};

/// All calls come from one thread.
class Queue {
  public:
    static constexpr std::size_t MAX_JOBS = 1000;
    static constexpr int MAX_TAG = 2'000'000'000;

    const std::vector<Job> &jobs() const { return jobs_; }
    /// Adds a program. A tag of 0 is replaced by the next number. Rejected: a tag in use, values out of
    /// range, a full queue.
    Result<> add(Job job);
    /// Null if there is none.
    const Job *by_tag(int tag) const;
    const Job *by_index(std::int64_t index) const;
    /// False if there is none.
    bool remove(int tag);
    bool set_priority(int tag, int priority);

    /// The next automatic tag is one more.
    int last_auto_tag() const { return last_auto_tag_; }
    Result<> set_last_auto_tag(int tag);
    /// Changes when the programs or their order change.
    std::uint32_t checksum() const;

  private:
    void insert(Job job);
    Result<int> next_tag() const;

    std::vector<Job> jobs_;
    int last_auto_tag_ = 0;
};

}  // namespace mw::schedule
