// SPDX-License-Identifier: GPL-2.0-or-later
// Task's side of the motion channels: ids, epochs, answers.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "machine/task/link/motion_watch.hh"
#include "motion/interface/channels.hh"

namespace mw::task {

/// All calls come from one thread. update() reports every rejection and failure exactly once.
class MotionLink {
  public:
    explicit MotionLink(motion::Channels &channels);

    struct Refusal {
        motion::Answer answer;
        motion::SourceTag source;  ///< source of a path command; line 0 for other commands
        bool is_table = false;     ///< a point of a screw table
    };
    struct News {
        std::vector<Refusal> refused;  ///< rejected commands; STALE commands belong to aborted work
        std::vector<motion::Fault> faults;
    };
    /// Reads status, answers and faults, and signals to the realtime side that task is alive. Called once in
    /// each task cycle.
    News update();

    const motion::Status &status() const { return copy_.value; }
    /// Parts of the status (motion::status_part) that the last update has received.
    PartMask fresh_parts() const { return fresh_; }

    /// Queues an immediate command. Commands are sent in order when the channel has space.
    motion::CommandId send(motion::CommandBody body);
    /// Queues the points of tables, which are sent after all other commands. The first rejected point ends
    /// its table and is reported once.
    void send_table(const std::vector<motion::LoadCompensation> &points);
    bool areTablesAnswered() const { return table_.empty() && table_pending_.empty(); }
    /// Sends a path command; false, and no effect, when the channel is full.
    bool push_path(const motion::PathBody &body, const motion::SourceTag &source = {});
    /// True while another move may be sent without filling the planner's queue.
    bool hasPathRoom() const;

    /// Requests the planner to run to the end of all moves sent.
    void flush();
    /// True if all moves sent are complete and the machine is stopped at their end.
    bool isPathComplete() const;
    /// True if the effect of digital and analog outputs on pins of motion has been received: the machine may
    /// have another pose (motion.switchkins-type), and linked inputs have changed.
    bool areOutputsSettled() const { return last_output_id_ == 0; }
    motion::CommandId last_path_id() const { return last_path_id_; }
    bool hasUnflushedPath() const { return last_path_id_ > flushed_id_; }

    /// Stops all motion along the path. Everything sent before becomes stale.
    void abort();
    MotionWatch &watch() { return watch_; }
    /// The last command from send() that motion has not answered; 0: none.
    motion::CommandId open_order() const { return pending_.empty() ? 0 : pending_.back(); }
    motion::Epoch epoch() const { return epoch_; }

    /// True if an immediate command has been answered (done or rejected), and status() is later than the
    /// answer. In another process the answer arrives before the snapshot of its cycle.
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
    /// Source positions of moves sent and not answered, oldest first.
    std::deque<std::pair<motion::CommandId, motion::SourceTag>> sources_;
    std::vector<motion::CommandId> pending_;        ///< unanswered immediate commands, in order
    std::deque<motion::LoadCompensation> table_;    ///< points not sent yet
    std::vector<motion::CommandId> table_pending_;  ///< points sent and not answered
    int refused_table_ = -1;                        ///< joint of the rejected table
    motion::CommandId next_id_ = 1;
    motion::CommandId last_path_id_ = 0;  ///< last path command sent
    motion::CommandId flushed_id_ = 0;    ///< the last Flush command
    motion::CommandId completed_id_ = 0;  ///< the last path command that was answered
    motion::CommandId last_output_id_ =
        0;                              ///< output command whose effect may not have been received, 0: none
    std::uint64_t output_cycle_ = 0;    ///< cycle of the first status after its answer, 0: none yet
    motion::CommandId aborted_id_ = 0;  ///< path commands up to this one belong to aborted work
    motion::Epoch epoch_ = 0;
    std::uint32_t path_outstanding_ = 0;
};

}  // namespace mw::task
