// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/link/motion_link.hh"

#include <algorithm>
#include <chrono>

#include "base/patient_read.hh"

namespace mw::task {
namespace {

/// Maximum number of moves sent and not complete, for the planner's look-ahead.
constexpr std::uint32_t PATH_WINDOW = 3000;
/// A servo thread whose write is interrupted for longer counts as dead. Its death is reported elsewhere.
constexpr std::chrono::milliseconds PATIENCE{20};
/// Servo cycles from an output to a linked input, through one or two components.
constexpr std::uint64_t ROUND_TRIP_CYCLES = 4;
/// Table points in transit; the rest of the channel is for other commands.
constexpr std::size_t TABLE_WINDOW = 256;

}  // namespace

MotionLink::MotionLink(motion::Channels &channels) : channels_(channels) {
    copy_.value.isInPosition = false;  // until motion reports the position
    if (read_patiently(channels_.status, copy_, PATIENCE)) {
        epoch_ = copy_.value.epoch;
    }
}

MotionLink::News MotionLink::update() {
    News news;
    // A realtime side that died during a write publishes nothing more.
    fresh_ = read_patiently(channels_.status, copy_, PATIENCE) ? copy_.fresh : 0;
    channels_.task_loops.fetch_add(1, std::memory_order_relaxed);
    take_answers(news);
    follow_outputs();
    motion::Fault fault;
    while (channels_.servo_faults.pop(fault)) {
        news.faults.push_back(fault);
    }
    while (channels_.planner_faults.pop(fault)) {
        news.faults.push_back(fault);
    }
    hand_over();
    hand_over_table();
    return news;
}

void MotionLink::take_answers(News &news) {
    motion::Answer answer;
    while (channels_.servo_answers.pop(answer)) {
        pending_.erase(std::remove(pending_.begin(), pending_.end(), answer.id), pending_.end());
        const bool is_table =
            std::find(table_pending_.begin(), table_pending_.end(), answer.id) != table_pending_.end();
        if (isToldRefusal(answer)) {
            news.refused.push_back({answer, {}, is_table});
        }
    }
    while (channels_.planner_answers.pop(answer)) {
        if (answer.id <= aborted_id_) {
            continue;
        }
        completed_id_ = std::max(completed_id_, answer.id);
        --path_outstanding_;
        const motion::SourceTag source = take_source(answer.id);
        if (answer.kind == motion::AnswerKind::REFUSED) {
            news.refused.push_back({answer, source, false});
        }
    }
}

void MotionLink::follow_outputs() {
    if (last_output_id_ == 0 || !isAnswered(last_output_id_)) {
        return;
    }
    const motion::Status &now = copy_.value;
    output_cycle_ = output_cycle_ == 0 ? now.cycle : output_cycle_;
    if (now.cycle >= output_cycle_ + ROUND_TRIP_CYCLES && now.isInPosition) {
        last_output_id_ = 0;
    }
}

/// True for the first rejection of a table, and for any other rejection.
bool MotionLink::isToldRefusal(const motion::Answer &answer) {
    const bool rejected = answer.kind == motion::AnswerKind::REFUSED;
    const auto point = std::find(table_pending_.begin(), table_pending_.end(), answer.id);
    if (point == table_pending_.end()) {
        return rejected;
    }
    table_pending_.erase(point);
    if (!rejected || refused_table_ == answer.index) {
        return false;
    }
    refused_table_ = answer.index;
    std::erase_if(table_, [&](const auto &p) { return p.joint == answer.index; });
    return true;
}

motion::SourceTag MotionLink::take_source(motion::CommandId id) {
    motion::SourceTag source;
    while (!sources_.empty() && sources_.front().first <= id) {
        source = sources_.front().first == id ? sources_.front().second : motion::SourceTag{};
        sources_.pop_front();
    }
    return source;
}

motion::CommandId MotionLink::send(motion::CommandBody body) {
    backlog_.push_back({next_id_++, epoch_, body});
    pending_.push_back(backlog_.back().id);
    const motion::CommandId id = backlog_.back().id;
    if (std::holds_alternative<motion::SetDigitalOutput>(body) ||
        std::holds_alternative<motion::SetAnalogOutput>(body)) {
        last_output_id_ = id;
        output_cycle_ = 0;
    }
    hand_over();
    return id;
}

void MotionLink::hand_over() {
    std::size_t sent = 0;
    while (sent < backlog_.size() && channels_.immediate.push(backlog_[sent])) {
        ++sent;
    }
    backlog_.erase(backlog_.begin(), backlog_.begin() + static_cast<std::ptrdiff_t>(sent));
}

void MotionLink::send_table(const std::vector<motion::LoadCompensation> &points) {
    table_.insert(table_.end(), points.begin(), points.end());
    refused_table_ = -1;
}

void MotionLink::hand_over_table() {
    while (!table_.empty() && backlog_.empty() && table_pending_.size() < TABLE_WINDOW &&
           channels_.immediate.push({next_id_, epoch_, table_.front()})) {
        pending_.push_back(next_id_);
        table_pending_.push_back(next_id_++);
        table_.pop_front();
    }
}

bool MotionLink::push_path(const motion::PathBody &body, const motion::SourceTag &source) {
    if (!channels_.path.push({next_id_, epoch_, body})) {
        return false;
    }
    last_path_id_ = next_id_++;
    sources_.emplace_back(last_path_id_, source);
    ++path_outstanding_;
    return true;
}

bool MotionLink::hasPathRoom() const {
    return path_outstanding_ < PATH_WINDOW && channels_.path.size() + 2 < channels_.path.capacity();
}

void MotionLink::flush() {
    if (hasUnflushedPath() && push_path(motion::Flush{})) {
        flushed_id_ = last_path_id_;
    }
}

bool MotionLink::isPathComplete() const {
    return completed_id_ >= last_path_id_ && !hasUnflushedPath();
}

void MotionLink::abort() {
    ++epoch_;
    send(motion::Abort{epoch_});
    // All earlier commands are stale, so their answers are not awaited.
    aborted_id_ = last_path_id_;
    sources_.clear();
    completed_id_ = std::max(completed_id_, last_path_id_);
    flushed_id_ = std::max(flushed_id_, last_path_id_);
    path_outstanding_ = 0;
}

}  // namespace mw::task
