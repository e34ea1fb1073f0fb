// SPDX-License-Identifier: GPL-2.0-or-later
// A mill in virtual time whose journal is on a disk that loses unsynced data. Runs a program, loses power,
// and starts again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "hal/core/instance.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/loaded_config.hh"
#include "machine/journal/test/torn_disk.hh"
#include "machine/journal/writer.hh"
#include "machine/task/task.hh"
#include "messages/client/client.hh"

namespace mw::power_cut {

/// A move as received by the planner, with the active state. All bits are compared.
struct Call {
    std::uint64_t id = 0;  ///< a different number in each run
    std::uint32_t block = 0;
    std::string bits;
    bool operator==(const Call &other) const { return block == other.block && bits == other.bits; }
};

/// The result of a run.
struct Recording {
    std::vector<Call> calls;
    /// For each millisecond: the block of the current move as motion reports it, 0 for none.
    std::vector<std::uint32_t> under_tool;
    std::string parameters;  ///< the parameter file after the run
    bool isDone = false;
};

/// Runs from an empty machine to its end; all errors are texts.
class Rig {
  public:
    /// `folder` must be a separate folder, into which the machine's files are copied.
    Rig(std::filesystem::path folder, journal::test::TornDisk &disk);
    ~Rig();

    /// Starts, switches on and homes the machine, with MDI lines before the program. Returns an empty text,
    /// or the error.
    std::string come_up(const std::vector<std::string> &mdi);
    /// All data of the process are lost; `disk` has already lost its power.
    void die();

    std::string begin(const std::string &program, int from_line = 0);
    /// One cycle of task; the journal is written when it is due.
    void cycle(std::mt19937_64 &random);
    /// No program is running or requested.
    bool hasEnded() const;
    std::string outcome();
    const messages::MachineStatus &status();
    /// Requests the interrupted program and confirms the approach. Returns an empty text, or the reason of
    /// the rejection.
    std::string recover();

    /// Returns an empty text when done, otherwise the reason.
    std::string ask(const messages::Command &command, int limit = 20000);
    machine::Machine &machine() { return *machine_; }
    const std::filesystem::path &folder() const { return folder_; }

    Recording recording;
    /// A power cut during a write of the journal, after this number of steps; negative: none.
    long steps_in_write = -1;
    /// Maximum delay of the journal's thread. [ms]
    int most_late_ms = 300;

  private:
    /// Motion reports the active devices with each move when it starts the move.
    void tell_what_is_on();
    void listen();
    void find_parameters();

    std::filesystem::path folder_;
    journal::test::TornDisk &disk_;
    std::string program_;
    diagnostics::Sink sink_;
    std::unique_ptr<machine::LoadedConfig> loaded_;
    std::unique_ptr<journal::Writer> writer_;
    std::unique_ptr<machine::Machine> machine_;
    client::Serial run_ = 0;
    int late_ms_ = -1;
    std::size_t told_ = 0;  ///< moves that motion has reached
};

}  // namespace mw::power_cut
