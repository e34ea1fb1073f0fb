// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine from an INI, under either clock.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "base/result.hh"
#include "hal/core/host.hh"
#include "machine/config/machine_config.hh"
#include "machine/task/task.hh"
#include "messages/client/client.hh"
#include "motion/interface/channels.hh"

namespace mw::machine {

/// What the machine is made from. All must outlive it; `ini` has been read into `config` without errors.
struct MachineParts {
    const ini::IniFile &ini;
    ini::IniReader &reader;
    const MachineConfig &config;
    diagnostics::Sink &sink;
};

struct MachineOptions {
    bool isClockVirtual = false;   ///< set by make_virtual_machine()
    bool isStrict = false;         ///< unknown INI keys are errors
    bool isLasting = false;        ///< it stays up for clients when a program has ended
    std::string homing_module;     ///< instead of [EMCMOT]HOMEMOD
    std::string planner_module;    ///< instead of [TRAJ]TPMOD
    bool isToolTableTold = false;  ///< whoever makes the machine has said what is wrong with the tool table
    std::string instance;          ///< HAL instance of a realtime machine; empty: the user's default
    /// Extra folders for HAL library files, before our own.
    std::vector<std::string> hal_library;
    /// Folders in which HAL files are looked for before that of the INI file.
    std::vector<std::string> hal_folders;
    /// Keeps the journal instead of one of the machine's own; it outlives the machine. Without it a machine
    /// under the virtual clock keeps none.
    journal::Writer *journal = nullptr;
    bool isKeptGoing = false;  ///< what fails in a HAL file is told, and the rest of it is run
};

/// Realtime figures of a run; zero under the virtual clock.
struct RealtimeFigures {
    bool isRealtime = false;
    std::string missing;  ///< why it is not realtime, empty otherwise
    std::uint64_t overruns = 0;
    std::int64_t max_latency_ns = 0;
};

/// One thread. Everything stops when it is destroyed: motion first, then the parts in reverse order of their
/// start.
class Machine {
  public:
    virtual ~Machine() = default;

    /// Runs up to and including the next task cycle.
    virtual void cycle() = 0;
    virtual std::int64_t now_ns() const = 0;
    virtual bool isVirtual() const = 0;
    virtual RealtimeFigures realtime_figures() const = 0;
    /// An error once the machine cannot go on: its realtime process has ended. Ask in every cycle.
    virtual Result<> health() const { return {}; }

    /// The way into task for whoever runs the machine in this process.
    virtual client::Client &client() = 0;
    /// For further clients in this process.
    virtual mailbox::Segment &mailbox() = 0;
    virtual task::Task &task() = 0;
    virtual motion::Channels &channels() = 0;
    virtual hal::Hal &hal() = 0;
};

/// Failures that concern lines of a file have been told to the sink, and say so (Error::isTold).
/// The machine in this process, under the virtual clock: deterministic, as fast as the processor allows.
Result<std::unique_ptr<Machine>> make_virtual_machine(const MachineParts &parts,
                                                      const MachineOptions &options);

/// The machine as two processes: this one with task, and the realtime process that it starts and that ends
/// with it.
Result<std::unique_ptr<Machine>> make_realtime_machine(const MachineParts &parts,
                                                       const MachineOptions &options);

}  // namespace mw::machine
