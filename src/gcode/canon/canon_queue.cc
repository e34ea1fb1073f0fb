// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/canon/canon_queue.hh"

#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

void CanonQueue::enter_block(const Program *program, int line, int sequence, bool isNumbered,
                             int call_level) {
    block_ = {program, line, sequence, call_level, isNumbered};
    block_marked_ = false;
}

void CanonQueue::mark_block() {
    if (!block_marked_ && block_.program != nullptr) {
        marks_.push_back({calls_.size(), block_});
        block_marked_ = true;
    }
}

void CanonQueue::take(const CanonCall &call) {
    mark_block();
    calls_.push_back(call);
}

void CanonQueue::truncate(std::size_t count) {
    if (count < calls_.size()) {
        calls_.erase(calls_.begin() + static_cast<std::ptrdiff_t>(count), calls_.end());
    }
    while (!marks_.empty() && marks_.back().call >= count) {
        marks_.pop_back();
    }
    block_marked_ = false;
}

void CanonQueue::rollback() {
    truncate(kept_);
    for (auto entry = changed_.rbegin(); entry != changed_.rend(); ++entry) {
        calls_[entry->first] = std::move(entry->second);
    }
    changed_.clear();
}

void CanonQueue::clear() {
    truncate(0);
    kept_ = 0;
    changed_.clear();
}

void CanonQueue::move_ends(std::size_t from, AxisEnd first, AxisEnd second) {
    for (std::size_t i = from; i < calls_.size(); ++i) {
        auto *const feed = std::get_if<StraightFeed>(&calls_[i]);
        auto *const traverse = std::get_if<StraightTraverse>(&calls_[i]);
        auto *const arc = std::get_if<ArcFeed>(&calls_[i]);
        if (feed == nullptr && traverse == nullptr && arc == nullptr) {
            continue;
        }
        if (i < kept_) {
            changed_.emplace_back(i, calls_[i]);
        }
        Pose &end = feed != nullptr ? feed->end : traverse != nullptr ? traverse->end : arc->end;
        end[first.axis] = first.value;
        end[second.axis] = second.value;
        if (arc != nullptr) {
            arc->first_end = first.value;
            arc->second_end = second.value;
        }
    }
}

void CanonQueue::flush(Canon &target, std::size_t count) {
    auto mark = marks_.begin();
    const auto announce = [&](std::size_t call) {
        for (; mark != marks_.end() && mark->call == call; ++mark) {
            const Block &b = mark->block;
            target.begin_block({b.program->path(), b.line, b.sequence, b.call_level,
                                b.program->line_text(b.line), b.isNumbered});
        }
    };
    for (std::size_t i = 0; i < count; ++i) {
        announce(i);
        target.take(calls_[i]);
    }
    if (count == calls_.size()) {
        calls_.clear();
        marks_.clear();
        kept_ = 0;
        return;
    }
    announce(count);  // the block of the first remaining call
    calls_.erase(calls_.begin(), calls_.begin() + static_cast<std::ptrdiff_t>(count));
    marks_.erase(marks_.begin(), mark);
    for (Mark &later : marks_) {
        later.call -= count;
    }
    kept_ = calls_.size();
}

}  // namespace mw::gcode::detail
