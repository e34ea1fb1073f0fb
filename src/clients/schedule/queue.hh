// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that wait to be run, in the order in which they will be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::schedule {

/// A program, and what is set before it begins.
struct Job {
    int priority = 0;            ///< the lowest comes first; of equals, the one that was added first
    int tag = 0;                 ///< names it; > 0
    double x = 0, y = 0, z = 0;  ///< origin in the first coordinate system, with zone 0 [program units]
    int zone = 0;                ///< 1 to 9: the origin is that of G54 to G59.3
    std::string file;
    double feed_percent = 100, spindle_percent = 100;  ///< overrides
    int tool = 0;                                      ///< 0: the one that is in the spindle
};

/// One thread.
class Queue {
  public:
    static constexpr std::size_t MAX_JOBS = 1000;
    static constexpr int MAX_TAG = 2'000'000'000;

    const std::vector<Job> &jobs() const { return jobs_; }
    /// A tag of 0 is replaced by the next number. Rejected: a tag that another has, values out of range, a
    /// full queue.
    Result<> add(Job job);
    /// Null: there is none.
    const Job *by_tag(int tag) const;
    const Job *by_index(std::int64_t index) const;
    /// False: there is none.
    bool remove(int tag);
    bool set_priority(int tag, int priority);

    /// The tag that a program without one gets next is one more.
    int last_auto_tag() const { return last_auto_tag_; }
    Result<> set_last_auto_tag(int tag);
    /// Another number when programs, or their order, are others.
    std::uint32_t checksum() const;

  private:
    void insert(Job job);
    Result<int> next_tag() const;

    std::vector<Job> jobs_;
    int last_auto_tag_ = 0;
};

}  // namespace mw::schedule
