// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of the run, and the offer to go on with one that a power cut, a crash or an emergency stop has
// ended (docs/integrator/journal.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "machine/journal/writer.hh"
#include "machine/task/link/tool_store.hh"
#include "machine/task/run/program_checksum.hh"
#include "machine/task/run/start_record.hh"
#include "machine/task/status.hh"

namespace mw::task {

/// The block that is not done, and the machine there.
struct RunPlace {
    std::uint32_t block = 0;
    int line = 0;
    geometry::Pose position;
    int tool = 0;
};

/// One thread; never waits.
class Recovery {
  public:
    /// `writer` null: nothing is journalled or offered.
    explicit Recovery(journal::Writer *writer) : writer_(writer) {}

    /// Takes up what the writer has found. A line for the operator, empty for none.
    std::string find();
    bool isOn() const { return writer_ != nullptr && writer_->isOn(); }

    /// A program is to begin. `why_not`: why its state cannot be told, empty: it can.
    void prepare(const std::string &program, const StartRecord &record, const std::string &why_not);
    /// It begins, with block `first`. A line for the operator where an offer ends with that, else empty.
    std::string begin(std::uint32_t first);
    /// The run that was offered goes on where it was, from the start that it was calculated with; `calls` and
    /// `tools`: checksums of what comes before that place, and of the tool table.
    void begin_again(const StartRecord &record, std::uint64_t calls, std::uint64_t tools);
    /// The run is to be calculated again up to `place`, because other tools are in the table: it is the one
    /// that offer() tells from here on. Refused where what holds there cannot be calculated.
    Result<> call_back(const RunPlace &place, ChecksumMarks &marks);
    /// Once a cycle of the run. `marks`: the canon's; `tools` as they are.
    void step(std::int64_t now_ns, const RunPlace &place, ChecksumMarks &marks, const ToolStore &tools);
    void note_doubt(std::uint32_t block, int line, const std::string &what);
    /// The run has come to its end, by itself or because somebody wanted it.
    void end();
    /// It was stopped in the middle: it is offered.
    void cut_short();
    /// What trouble there is with the journal, once.
    std::optional<std::string> take_trouble();
    /// Of the disk of the journal and of the files beside it, as Writer::take_delay().
    std::optional<std::string> take_delay(std::int64_t now_ns);

    /// Nothing when there is none, or it is refused.
    Result<const journal::Run *> offer() const;
    /// Looked at closely it cannot be gone on with.
    void refuse(const std::string &why) { refusal_ = why; }
    void forget();
    void show(RecoveryStatus &status) const;

  private:
    void note(const RunPlace &place, ChecksumMarks &marks, const ToolStore &tools);
    void offer_run(journal::Run run);

    journal::Writer *writer_;
    std::optional<journal::Run> offer_;
    std::string refusal_;
    std::optional<journal::Run> prepared_;
    std::optional<journal::Run> run_;  ///< that goes on now
    std::uint32_t first_ = 0;          ///< its first block here
    std::int64_t noted_ns_ = 0;
    std::uint64_t summed_version_ = 0, sum_of_tools_ = 0;
};

/// Of a file that was looked at when the machine came up and has not changed since.
std::string refusal_of(const journal::Run &run);

}  // namespace mw::task
