// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of the run, and the offer to continue a run that a power cut, a crash or an emergency stop has
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

/// The first block that is not done, and the state of the machine there.
struct RunPlace {
    std::uint32_t block = 0;
    int line = 0;
    geometry::Pose position;
    int tool = 0;
};

/// One thread; does not wait.
class Recovery {
  public:
    /// `writer` null: runs are not journalled and not offered.
    explicit Recovery(journal::Writer *writer) : writer_(writer) {}

    /// Reads the writer's findings. Returns a message for the operator, empty for none.
    std::string find();
    bool isOn() const { return writer_ != nullptr && writer_->isOn(); }

    /// Called before a program starts. `why_not`: the reason why its state cannot be stored; empty: it can be
    /// stored.
    void prepare(const std::string &program, const StartRecord &record, const std::string &why_not);
    /// The program starts with block `first`. Returns a message for the operator if that ends an offer, else
    /// empty.
    std::string begin(std::uint32_t first);
    /// The offered run continues from the start with which it was calculated; `calls` and `tools`: checksums
    /// of the calls before that position, and of the tool table.
    void begin_again(const StartRecord &record, std::uint64_t calls, std::uint64_t tools);
    /// The run will be calculated again up to `place`, because the tool table has changed. From now on
    /// offer() returns it. Rejected if its state cannot be calculated.
    Result<> call_back(const RunPlace &place, ChecksumMarks &marks);
    /// Called once in each cycle of the run. `marks` are those of the canon, `tools` the current tools.
    void step(std::int64_t now_ns, const RunPlace &place, ChecksumMarks &marks, const ToolStore &tools);
    void note_doubt(std::uint32_t block, int line, const std::string &what);
    /// Called when the run has ended normally or was ended on request.
    void end();
    /// Called when the run was interrupted: it is offered.
    void cut_short();
    /// Message about a problem with the journal; returned once.
    std::optional<std::string> take_trouble();
    /// For the disk of the journal and its files, as Writer::take_delay().
    std::optional<std::string> take_delay(std::int64_t now_ns);

    /// The offered run. An error when there is none, or it cannot be continued.
    Result<const journal::Run *> offer() const;
    /// Called when a further check found that it cannot be continued.
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
    std::optional<journal::Run> run_;  ///< the current run
    std::uint32_t first_ = 0;          ///< number of its first block in this session
    std::int64_t noted_ns_ = 0;
    std::uint64_t summed_version_ = 0, sum_of_tools_ = 0;
};

/// For a file that was checked when the machine started, and that has not changed since then.
std::string refusal_of(const journal::Run &run);

}  // namespace mw::task
