// SPDX-License-Identifier: GPL-2.0-or-later
// The canon that runs a program: appends calls to the ordered queue, never blocks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gcode/canon/machine_canon.hh"
#include "machine/task/run/program_checksum.hh"
#include "machine/task/sequencer/items.hh"

namespace mw::task {

/// Tool change position ([EMCIO]TOOL_CHANGE_POSITION; requirement G5).
struct ToolChangePlace {
    int coordinates = 0;      ///< number of coordinates in `position`: 0, 3, 6 or 9
    geometry::Pose position;  ///< [machine units], machine coordinates
};

/// Moves of a tool change from `position`, in order; empty if the machine does not move.
std::vector<geometry::Pose> tool_change_moves(const ToolChangePlace &place, const geometry::Pose &position);

class TaskCanon final : public gcode::MachineCanon {
  public:
    explicit TaskCanon(ItemQueue &queue, const ToolChangePlace &place = {}) : queue_(queue), place_(place) {}

    /// Number of blocks since reset(), which is the number of the current block.
    std::uint32_t blocks() const { return tag_.block; }
    /// The name of a file by the index in SourceTag.
    const std::string &file_name(std::uint32_t index) const { return files_[index]; }
    /// Text of the last block.
    const std::string &block_text() const { return text_; }
    /// The last announced offsets. They are active when the queue has been executed, and when nothing runs.
    /// Nothing before the first.
    const std::optional<gcode::UseOffsets> &offsets() const { return offsets_; }
    const std::optional<geometry::Pose> &tool_offset() const { return tool_offset_; }
    void reset();
    /// Sets the number of earlier blocks.
    void set_blocks(std::uint32_t blocks) { tag_.block = blocks; }
    /// Checksums of the program's calls; off until begun.
    ChecksumMarks &marks() { return marks_; }
    /// The following calls belong to a new step of the interpreter.
    void begin_read() {
        ++read_;
        asking_ = false;
    }
    /// The number of the current step.
    std::uint64_t reads() const { return read_; }
    /// True if the current step has made calls.
    bool isAsking() const { return asking_; }
    /// Gives a block without calls its position in the order: it is executed when the queue reaches it.
    void pass_block(const gcode::BlockRef &block);
    /// Inserts calls before all waiting calls, starting at `position`; they belong to line `line` and step
    /// `read`.
    void insert_first(const std::vector<gcode::MachineCall> &calls, const geometry::Pose &position, int line,
                      std::uint64_t read);
    /// The exact end of the last move if the machine is at this position within rounding, else the position
    /// of the machine. So values that a program reads do not depend on rounding errors of the motion.
    geometry::Pose exact(const geometry::Pose &machine) const;
    /// Position of the machine when nothing is queued.
    void set_position(const geometry::Pose &position) { last_end_ = position; }

    /// Sends calls to `queue`; null: to the normal queue again.
    void divert(ItemQueue *queue) { diverted_ = queue; }

    void begin_block(const gcode::BlockRef &block) override;
    void take(const gcode::MachineCall &call) override;

  private:
    void put(const gcode::MachineCall &call);
    void add(const gcode::MachineCall &call) {
        (diverted_ != nullptr ? *diverted_ : queue_).push_back({tag_, call, read_});
        asking_ = true;
    }
    void enter_line(const gcode::BlockRef &block);
    void change_tool();

    ItemQueue &queue_;
    ItemQueue *diverted_ = nullptr;
    ToolChangePlace place_;
    geometry::Pose last_end_{};
    motion::SourceTag tag_{};
    std::uint64_t read_ = 0;
    bool asking_ = false;
    std::vector<std::string> files_;
    std::string text_;
    ChecksumMarks marks_;
    std::optional<gcode::UseOffsets> offsets_;
    std::optional<geometry::Pose> tool_offset_;
};

}  // namespace mw::task
