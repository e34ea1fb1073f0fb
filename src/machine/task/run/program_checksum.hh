// SPDX-License-Identifier: GPL-2.0-or-later
// A checksum of what a program asks for: two runs that agree in it have asked for the same.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>

#include "gcode/canon/machine_canon.hh"

namespace mw::task {

class ProgramChecksum {
  public:
    void add(const gcode::MachineCall &call);
    std::uint64_t value() const { return value_; }

  private:
    void mix(std::uint64_t word);
    void mix(double number);
    void mix(const geometry::Pose &pose);
    void mix(const geometry::MoveSettings &settings);

    std::uint64_t value_ = 0;
};

/// The sums at the beginnings of the blocks that are read and not done. One thread.
class ChecksumMarks {
  public:
    /// `before`: of all that came before the blocks that come now.
    void begin(ProgramChecksum before) {
        sum_ = before;
        marks_.clear();
        isOn_ = true;
    }
    void end() {
        isOn_ = false;
        marks_.clear();
    }
    bool isOn() const { return isOn_; }
    void begin_block(std::uint32_t block) {
        if (isOn_) {
            marks_.emplace_back(block, sum_.value());
        }
    }
    void add(const gcode::MachineCall &call) {
        if (isOn_) {
            sum_.add(call);
        }
    }
    /// Of all calls before `block`; those before it are forgotten. Nothing where it has not begun.
    std::optional<std::uint64_t> before(std::uint32_t block) {
        while (!marks_.empty() && marks_.front().first < block) {
            marks_.pop_front();
        }
        const bool isThere = !marks_.empty() && marks_.front().first == block;
        return isThere ? std::optional(marks_.front().second) : std::nullopt;
    }

  private:
    bool isOn_ = false;
    ProgramChecksum sum_;
    std::deque<std::pair<std::uint32_t, std::uint64_t>> marks_;
};

}  // namespace mw::task
