// SPDX-License-Identifier: GPL-2.0-or-later
// The newest observations of data items, by sequence number.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "clients/publish/mtconnect/device_model.hh"

namespace mw::publish::mtconnect {

using Sequence = std::uint64_t;

inline constexpr const char *UNAVAILABLE = "UNAVAILABLE";

/// The value of a condition is the text of its fault, empty if it is normal.
struct Observation {
    Sequence sequence = 0;
    ItemId item = 0;
    TimeMs at = 0;
    std::string value;
};

/// A ring of `capacity` observations. When an observation is overwritten, its value remains as the state
/// before the first one. One thread at a time.
class Observations {
  public:
    /// Each item is initially UNAVAILABLE.
    Observations(std::size_t items, std::size_t capacity, TimeMs at);

    void add(ItemId item, std::string value, TimeMs at);
    /// The newest value of an item.
    const std::string &value(ItemId item) const { return newest_[item].value; }
    Sequence first() const { return ring_.front().sequence; }
    Sequence last() const { return ring_.back().sequence; }
    Sequence next() const { return last() + 1; }
    std::size_t capacity() const { return capacity_; }
    /// The observation with number `sequence`, from first() to last().
    const Observation &get(Sequence sequence) const { return ring_[sequence - first()]; }

    /// The newest observation of each item.
    const std::vector<Observation> &current() const { return newest_; }
    /// As current(), at the time when `sequence` was the last number.
    std::vector<Observation> at(Sequence sequence) const;

  private:
    std::size_t capacity_;
    std::deque<Observation> ring_;
    std::vector<Observation> newest_, before_;  ///< newest observation of each item; before_: observations at
                                                ///< the start of the ring
};

}  // namespace mw::publish::mtconnect
