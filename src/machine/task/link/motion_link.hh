// SPDX-License-Identifier: GPL-2.0-or-later
// Task's side of the motion channels: ids, epochs, answers.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "machine/task/link/motion_watch.hh"
#include "motion/interface/channels.hh"

namespace mw::task {

/// One thread. Everything refused or failed comes out of update() exactly once.
class MotionLink {
  public:
    explicit MotionLink(motion::Channels &channels);

    struct Refusal {
        motion::Answer answer;
        motion::SourceTag source;  ///< of a path command; line 0 when it is none
        bool isTable = false;      ///< of a point of a screw table
    };
    struct News {
        std::vector<Refusal> refused;  ///< REFUSED only; STALE ones belong to work that was aborted
        std::vector<motion::Fault> faults;
    };
    /// Takes status, answers and faults, and tells the realtime side that task is alive. Once a task cycle.
    News update();

    const motion::Status &status() const { return copy_.value; }
    /// Parts of the status (motion::status_part) that came with the last update.
    PartMask fresh_parts() const { return fresh_; }

    /// Queues an immediate command; they are handed over in order as the channel has room.
    motion::CommandId send(motion::CommandBody body);
    /// Queues points of tables, which many are: everything else goes first, and a refusal of one ends its
    /// table and is told once.
    void send_table(const std::vector<motion::LoadCompensation> &points);
    bool areTablesAnswered() const { return table_.empty() && table_pending_.empty(); }
    /// Hands a path command over; false when the channel is full (nothing happens then).
    bool push_path(const motion::PathBody &body, const motion::SourceTag &source = {});
    /// True while another move may be handed over without filling the planner's queue.
    bool hasPathRoom() const;

    /// Asks the planner to run to the end of everything handed over.
    void flush();
    /// Nothing handed over is still to be executed and the machine is at rest at the end of it.
    bool isPathComplete() const;
    /// What digital and analog outputs do to pins of motion has been seen: the machine may have another pose
    /// since (motion.switchkins-type), and inputs that are linked to outputs follow them.
    bool areOutputsSettled() const { return last_output_id_ == 0; }
    motion::CommandId last_path_id() const { return last_path_id_; }
    bool hasUnflushedPath() const { return last_path_id_ > flushed_id_; }

    /// Stops all motion along the path and makes everything handed over before it stale.
    void abort();
    MotionWatch &watch() { return watch_; }
    /// The newest order of send() that motion has not answered; 0: none.
    motion::CommandId open_order() const { return pending_.empty() ? 0 : pending_.back(); }
    motion::Epoch epoch() const { return epoch_; }

    /// An immediate command has been answered (done or refused), and status() is of a time after it. In
    /// another process the answer comes before the snapshot of its cycle.
    bool isAnswered(motion::CommandId id) const {
        return (pending_.empty() || id < pending_.front()) && id <= copy_.value.last_immediate_id;
    }

  private:
    void hand_over();
    void follow_outputs();
    void hand_over_table();
    bool isToldRefusal(const motion::Answer &answer);
    void take_answers(News &news);
    motion::SourceTag take_source(motion::CommandId id);

    motion::Channels &channels_;
    MotionWatch watch_;
    motion::PublishedStatus::Copy copy_;
    PartMask fresh_ = 0;
    std::vector<motion::Command> backlog_;
    /// Where the moves handed over and not answered come from, oldest first.
    std::deque<std::pair<motion::CommandId, motion::SourceTag>> sources_;
    std::vector<motion::CommandId> pending_;        ///< immediate commands not yet answered, in order
    std::deque<motion::LoadCompensation> table_;    ///< points that are not handed over yet
    std::vector<motion::CommandId> table_pending_;  ///< that are, and are not answered
    int refused_table_ = -1;                        ///< its joint
    motion::CommandId next_id_ = 1;
    motion::CommandId last_path_id_ = 0;    ///< handed over
    motion::CommandId flushed_id_ = 0;      ///< the last Flush
    motion::CommandId completed_id_ = 0;    ///< the last path command answered
    motion::CommandId last_output_id_ = 0;  ///< whose effect may not have been seen, 0: none
    std::uint64_t output_cycle_ = 0;        ///< of the first status after it was answered, 0: none yet
    motion::CommandId aborted_id_ = 0;      ///< path commands up to this one belong to aborted work
    motion::Epoch epoch_ = 0;
    std::uint32_t path_outstanding_ = 0;
};

}  // namespace mw::task
