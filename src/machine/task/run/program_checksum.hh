// SPDX-License-Identifier: GPL-2.0-or-later
// A checksum of the commands of a program. Two runs with the same checksum have sent the same commands.
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

/// Checksums at the starts of blocks that are read and not done. All calls come from one thread.
class ChecksumMarks {
  public:
    /// `before`: checksum of all earlier calls.
    void begin(ProgramChecksum before) {
        sum_ = before;
        marks_.clear();
        on_ = true;
    }
    void end() {
        on_ = false;
        marks_.clear();
    }
    bool isOn() const { return on_; }
    void begin_block(std::uint32_t block) {
        if (on_) {
            marks_.emplace_back(block, sum_.value());
        }
    }
    void add(const gcode::MachineCall &call) {
        if (on_) {
            sum_.add(call);
        }
    }
    /// Checksum of all calls before `block`; drops older ones. Nothing before begin().
    std::optional<std::uint64_t> before(std::uint32_t block) {
        while (!marks_.empty() && marks_.front().first < block) {
            marks_.pop_front();
        }
        const bool present = !marks_.empty() && marks_.front().first == block;
        return present ? std::optional(marks_.front().second) : std::nullopt;
    }

  private:
    bool on_ = false;
    ProgramChecksum sum_;
    std::deque<std::pair<std::uint32_t, std::uint64_t>> marks_;
};

}  // namespace mw::task
