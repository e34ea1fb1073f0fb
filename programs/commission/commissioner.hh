// SPDX-License-Identifier: GPL-2.0-or-later
// Runs the machine of a folder with the guide of commissioning. It starts the machine; when a step has
// changed an answer, it writes the files and starts the machine again.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "base/diagnostics/sink.hh"
#include "machine/assembly/machine.hh"
#include "machine/commissioning/guide.hh"
#include "machine/commissioning/live_bench.hh"
#include "machine/config/loaded_config.hh"

namespace mw::programs {

struct CommissionSetup {
    std::string folder;
    bool clock_virtual = true;
    /// Findings of earlier sessions, and the steps of this session; null: all steps.
    std::vector<commissioning::Finding> known{};
    bool (*isWanted)(const commissioning::Step &) = nullptr;
    /// The INI file that is started instead of the written file, for machines with additional parts; null:
    /// the written file.
    std::function<Result<std::string>(const std::string &ini)> prepare;
    /// Called for each machine after its start, before its first cycle.
    std::function<void(machine::Machine &)> on_start;
    /// Creates a bench that wraps the machine's bench; null: none.
    std::function<std::unique_ptr<commissioning::Bench>(commissioning::Bench &)> wrap;
};

/// All calls come from one thread.
class Commissioner {
  public:
    static Result<std::unique_ptr<Commissioner>> open(CommissionSetup setup);
    ~Commissioner();

    commissioning::Guide &guide() { return *guide_; }
    machine::Machine &machine() { return *machine_; }
    /// Runs one task cycle, and restarts the machine when the guide requests it.
    Result<> cycle();
    /// Ends the current step and waits until the machine and its outputs are off.
    void stop();
    /// Writes the answers of the guide, and starts the machine again.
    Result<> restart();

  private:
    explicit Commissioner(CommissionSetup setup) : setup_(std::move(setup)) {}
    Result<> start();
    void end_machine();

    CommissionSetup setup_;
    std::unique_ptr<commissioning::Guide> guide_;
    diagnostics::Sink sink_;
    std::unique_ptr<machine::LoadedConfig> loaded_;
    std::unique_ptr<machine::Machine> machine_;
    std::unique_ptr<commissioning::LiveBench> bench_;
    std::unique_ptr<commissioning::Bench> wrapped_;
};

}  // namespace mw::programs
