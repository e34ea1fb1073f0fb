// SPDX-License-Identifier: GPL-2.0-or-later
// Everything of a machine that is not realtime: I/O and task pins, halui, HAL files, tool table, task.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/core/host.hh"
#include "hal/script/programs.hh"
#include "machine/assembly/ini_pins.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/ini_parameters.hh"
#include "machine/halui/halui.hh"
#include "machine/io/pins.hh"
#include "machine/journal/writer.hh"
#include "machine/task/task.hh"
#include "machine/tools/tool_changer.hh"
#include "machine/tools/tool_data.hh"

namespace mw::machine {

/// One thread. start() leaves a machine whose threads run and whose task takes commands once configure is
/// done.
class TaskSide final : private task::IoPins {
  public:
    /// `programs`: what starts the programs of HAL files, and outlives this; null: none are started.
    TaskSide(const MachineParts &parts, hal::Host &host, mailbox::Memory mailbox,
             hal::script::ProgramHost *programs);
    ~TaskSide() override;

    /// Makes pins, runs the HAL files, starts the threads, makes task and gives it the motion settings.
    Result<> start(const MachineOptions &options);
    /// Runs cycles until motion has taken all settings, then reads the parameter file and announces the state
    /// to the interpreter. An error names the first setting that was refused.
    Result<> finish_start(Machine &machine, int most_cycles);
    /// One task cycle.
    void step(std::int64_t now_ns);
    /// The same while step() is in a long call (task::LongCall).
    void step_apart(std::int64_t now_ns);

    client::Client &client() { return *client_; }
    mailbox::Segment &mailbox() { return mailbox_.segment(); }
    /// What waits for the disk is written, at most 0.5 s; nothing is written afterwards.
    void finish_files() {
        if (journal_ != nullptr) {
            journal_->finish();
        }
    }
    /// No client finds the machine any more.
    void remove_mailbox() { mailbox_.remove(); }
    task::Task &task() { return *task_; }
    motion::Channels &channels() { return *channels_; }

  private:
    /// Of those who operate by pins.
    void step_hands(std::int64_t now_ns);
    io::Inputs read() override { return io_pins_.read(); }
    void write(const io::Outputs &outputs) override { io_pins_.write(outputs); }
    bool isPersonAsked() const override { return tool_change_.isAsking(); }
    void confirm_tool_change() override { tool_change_.confirm(); }

    Result<> take_places();
    Result<> identify();
    Result<bool> isConfigured();
    Result<> make_pins();
    Result<> run_hal_files(const MachineOptions &options);
    void tell_tool_change(ToolHand hand, const std::string &text);
    Result<> join_motion();
    /// Lets the servo thread itself see the e-stop chain that iocontrol.0.emc-enable-in sees.
    Result<> link_estop_chain();

    MachineParts parts_;
    hal::Host &host_;
    hal::script::ProgramHost *programs_;
    mailbox::Memory mailbox_;  ///< outlives its clients
    std::optional<client::Client> client_;
    io::Pins io_pins_;
    IniPins ini_pins_;
    halui::Halui halui_;
    ManualToolChange tool_change_;
    IniParameters parameters_;
    std::unique_ptr<journal::Writer> journal_;  ///< outlives all that it keeps things for
    std::unique_ptr<task::ToolStore> tools_;
    bool isLasting_ = false;
    motion::Channels *channels_ = nullptr;
    std::unique_ptr<task::Task> task_;
};

}  // namespace mw::machine
