// SPDX-License-Identifier: GPL-2.0-or-later
// MDI lines and taps from clients that wait for the running line ([TASK]MDI_QUEUED_COMMANDS).
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hh"
#include "gcode/canon/machine_canon.hh"
#include "machine/task/command.hh"
#include "messages/mailbox/segment.hh"

namespace mw::task {

/// MDI lines in order. All calls come from one thread.
class MdiQueue {
  public:
    struct Line {
        mailbox::Serial command = 0;
        std::string text;
        std::optional<RigidTapMove> tap;  ///< a tap instead of a text
        mailbox::Authority authority = mailbox::Authority::OPERATE;
    };
    explicit MdiQueue(int most) : most_(most) {}

    /// Rejected when the queue is full.
    Result<Progress> add(Line line) {
        if (size() >= most_) {
            return fail(most_ == 0 ? "an MDI line is already running"
                                   : std::to_string(most_) + " MDI lines are already waiting",
                        {}, "[TASK]MDI_QUEUED_COMMANDS is the maximum");
        }
        waiting_.push_back(std::move(line));
        return Progress::STARTED;
    }
    std::optional<Line> next() {
        if (waiting_.empty()) {
            return std::nullopt;
        }
        Line line = std::move(waiting_.front());
        waiting_.pop_front();
        return line;
    }
    /// Spindle synchronisation of later taps from clients.
    void set_sync(const SetSpindleSync &sync) { sync_ = sync; }
    const SetSpindleSync &sync() const { return sync_; }
    /// Marks the starting line as this tap.
    void set_tap(const gcode::TapMove &tap) { tap_ = tap; }
    std::optional<gcode::TapMove> take_tap() { return std::exchange(tap_, std::nullopt); }
    /// Removes and returns all lines.
    std::vector<mailbox::Serial> drop() {
        std::vector<mailbox::Serial> dropped;
        for (const Line &line : waiting_) {
            dropped.push_back(line.command);
        }
        waiting_.clear();
        tap_.reset();
        sync_ = {};
        return dropped;
    }
    int size() const { return static_cast<int>(waiting_.size()); }

  private:
    int most_;
    std::deque<Line> waiting_;
    SetSpindleSync sync_;
    std::optional<gcode::TapMove> tap_;
};

}  // namespace mw::task
