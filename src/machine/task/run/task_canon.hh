// SPDX-License-Identifier: GPL-2.0-or-later
// The canon that runs a program: appends to the ordered queue, never blocks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gcode/canon/machine_canon.hh"
#include "machine/task/run/program_checksum.hh"
#include "machine/task/sequencer/items.hh"

namespace mw::task {

/// Where the machine goes for a tool change ([EMCIO]TOOL_CHANGE_POSITION; requirement
/// G5).
struct ToolChangePlace {
    int coordinates = 0;      ///< how many of `position` are given: 0, 3, 6 or 9
    geometry::Pose position;  ///< [machine units], machine coordinates
};

/// Where a tool change goes from `position`, in order; empty when it stays.
std::vector<geometry::Pose> tool_change_moves(const ToolChangePlace &place, const geometry::Pose &position);

class TaskCanon final : public gcode::MachineCanon {
  public:
    explicit TaskCanon(ItemQueue &queue, const ToolChangePlace &place = {}) : queue_(queue), place_(place) {}

    /// Blocks seen since reset(); the number of the current one.
    std::uint32_t blocks() const { return tag_.block; }
    /// The name of a file by the index in SourceTag.
    const std::string &file_name(std::uint32_t index) const { return files_[index]; }
    /// The block that was read last, as it is written.
    const std::string &block_text() const { return text_; }
    /// The offsets that were announced last: those in force once the queue is carried out, and where nothing
    /// runs. Nothing before the first.
    const std::optional<gcode::UseOffsets> &offsets() const { return offsets_; }
    const std::optional<geometry::Pose> &tool_offset() const { return tool_offset_; }
    void reset();
    /// So many have come before.
    void set_blocks(std::uint32_t blocks) { tag_.block = blocks; }
    /// Checksums of what the program asks for; off until they are begun.
    ChecksumMarks &marks() { return marks_; }
    /// Calls from here on belong to another step of the interpreter.
    void begin_read() {
        ++read_;
        isAsking_ = false;
    }
    /// The number of that step.
    std::uint64_t reads() const { return read_; }
    /// That step has asked the machine for something.
    bool isAsking() const { return isAsking_; }
    /// A block that asks the machine for nothing keeps its place in the order: it is executed when the queue
    /// comes to it.
    void pass_block(const gcode::BlockRef &block);
    /// What is done before all that waits, from `position` on; as of `line` and of step `read`.
    void insert_first(const std::vector<gcode::MachineCall> &calls, const geometry::Pose &position, int line,
                      std::uint64_t read);
    /// Where the machine stands: the end of the last move, where it is that but for the rounding of those who
    /// have brought it there. So what a program says does not depend on them.
    geometry::Pose exact(const geometry::Pose &machine) const;
    /// Where the machine is when nothing is queued.
    void set_position(const geometry::Pose &position) { last_end_ = position; }

    /// Calls go there, and not to the queue; null: to the queue again.
    void divert(ItemQueue *queue) { diverted_ = queue; }

    void begin_block(const gcode::BlockRef &block) override;
    void take(const gcode::MachineCall &call) override;

  private:
    void put(const gcode::MachineCall &call);
    void add(const gcode::MachineCall &call) {
        (diverted_ != nullptr ? *diverted_ : queue_).push_back({tag_, call, read_});
        isAsking_ = true;
    }
    void enter_line(const gcode::BlockRef &block);
    void change_tool();

    ItemQueue &queue_;
    ItemQueue *diverted_ = nullptr;
    ToolChangePlace place_;
    geometry::Pose last_end_{};
    motion::SourceTag tag_{};
    std::uint64_t read_ = 0;
    bool isAsking_ = false;
    std::vector<std::string> files_;
    std::string text_;
    ChecksumMarks marks_;
    std::optional<gcode::UseOffsets> offsets_;
    std::optional<geometry::Pose> tool_offset_;
};

}  // namespace mw::task
