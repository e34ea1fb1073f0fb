// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine from an INI file, under the realtime or the virtual clock.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::client {
class Client;
}
namespace mw::diagnostics {
class Sink;
}
namespace mw::hal {
class Instance;
}
namespace mw::ini {
class IniFile;
class IniReader;
}  // namespace mw::ini
namespace mw::journal {
class Writer;
}
namespace mw::mailbox {
class Segment;
}
namespace mw::motion {
struct Channels;
}
namespace mw::task {
class Task;
}

namespace mw::machine {

struct MachineConfig;

/// Parts from which a machine is created. All must outlive it; `ini` has been read into `config` without
/// errors.
struct MachineParts {
    const ini::IniFile &ini;
    ini::IniReader &reader;
    const MachineConfig &config;
    diagnostics::Sink &sink;
};

struct MachineOptions {
    bool clock_virtual = false;        ///< set by make_virtual_machine()
    bool strict = false;               ///< unknown INI keys are errors
    bool isLasting = false;            ///< keeps running for clients after a program has ended
    std::string homing_module;         ///< replaces [EMCMOT]HOMEMOD
    std::string planner_module;        ///< replaces [TRAJ]TPMOD
    bool tool_table_reported = false;  ///< the caller has reported errors in the tool table
    std::string instance;              ///< HAL instance of a realtime machine; empty: the user's default
    /// Additional folders of HAL library files, searched before our own.
    std::vector<std::string> hal_library;
    /// Folders in which HAL files are searched before that of the INI file.
    std::vector<std::string> hal_folders;
    /// Replaces the machine's own journal; it must outlive the machine. Without it a machine under the
    /// virtual clock has no journal.
    journal::Writer *journal = nullptr;
    bool kept_going = false;  ///< errors in a HAL file are reported, and its other lines are run
};

/// Realtime figures of a run; zero under the virtual clock.
struct RealtimeFigures {
    bool realtime = false;
    std::string missing;  ///< reason why the machine is not realtime, else empty
    std::uint64_t overruns = 0;
    std::int64_t max_latency_ns = 0;
};

/// All calls come from one thread. The destructor stops everything: motion first, then the parts in reverse
/// order of their start.
class Machine {
  public:
    virtual ~Machine() = default;

    /// Runs up to and including the next task cycle.
    virtual void cycle() = 0;
    virtual std::int64_t now_ns() const = 0;
    virtual bool isVirtual() const = 0;
    virtual RealtimeFigures realtime_figures() const = 0;
    /// An error when the machine cannot continue because its realtime process has ended. Check in every
    /// cycle.
    virtual Result<> health() const { return {}; }

    /// The client for the code that runs the machine in this process.
    virtual client::Client &client() = 0;
    /// The mailbox for more clients in this process.
    virtual mailbox::Segment &mailbox() = 0;
    virtual task::Task &task() = 0;
    virtual motion::Channels &channels() = 0;
    virtual hal::Instance &hal() = 0;
    /// Stores small files without waiting for the disk; null under the virtual clock. [task's thread]
    virtual journal::Writer *journal() { return nullptr; }
};

/// Creates the machine in this process, under the virtual clock: deterministic, as fast as the processor
/// allows. Errors in lines of a file have been reported to the sink, and have Error::isTold set.
Result<std::unique_ptr<Machine>> make_virtual_machine(const MachineParts &parts,
                                                      const MachineOptions &options);

/// Creates the machine as two processes: this one with task, and the realtime process, which it starts and
/// which ends with it.
Result<std::unique_ptr<Machine>> make_realtime_machine(const MachineParts &parts,
                                                       const MachineOptions &options);

}  // namespace mw::machine
