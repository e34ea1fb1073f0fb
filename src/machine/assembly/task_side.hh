// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a machine that is not realtime: I/O and task pins, halui, HAL files, tool table, task.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "hal/core/host.hh"
#include "hal/script/programs.hh"
#include "machine/assembly/ini_pins.hh"
#include "machine/assembly/machine.hh"
#include "machine/config/ini_parameters.hh"
#include "machine/config/machine_config.hh"
#include "machine/halui/halui.hh"
#include "machine/io/pins.hh"
#include "machine/journal/writer.hh"
#include "machine/task/task.hh"
#include "machine/tools/tool_changer.hh"
#include "machine/tools/tool_data.hh"
#include "messages/client/client.hh"
#include "motion/interface/channels.hh"

namespace mw::machine {

/// All calls come from one thread. After start() the machine's threads run, and task accepts commands once
/// the configuration is complete.
class TaskSide final : private task::IoPins {
  public:
    /// `programs` starts the programs of HAL files and must outlive this object; null: none are started.
    TaskSide(const MachineParts &parts, hal::Host &host, mailbox::Memory mailbox,
             hal::script::ProgramHost *programs);
    ~TaskSide() override;

    /// Creates pins, runs the HAL files, starts the threads, creates task and sends the motion settings.
    Result<> start(const MachineOptions &options);
    /// Runs cycles until motion has accepted all settings, then reads the parameter file and announces the
    /// state to the interpreter. An error names the first rejected setting.
    Result<> finish_start(Machine &machine, int most_cycles);
    /// One task cycle.
    void step(std::int64_t now_ns);
    /// A task cycle while step() is in a long call (task::LongCall).
    void step_apart(std::int64_t now_ns);

    client::Client &client() { return *client_; }
    mailbox::Segment &mailbox() { return mailbox_.segment(); }
    /// Writes pending files, waiting at most 0.5 s. Nothing is written afterwards.
    void finish_files() {
        if (journal_ != nullptr) {
            journal_->finish();
        }
    }
    /// After this, clients do not find the machine.
    void remove_mailbox() { mailbox_.remove(); }
    task::Task &task() { return *task_; }
    /// Null under the virtual clock, and if the options contain a journal.
    journal::Writer *journal() { return journal_.get(); }
    motion::Channels &channels() { return *channels_; }

  private:
    /// Runs the clients that use HAL pins.
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
    /// Links the servo thread to the e-stop chain of iocontrol.0.emc-enable-in.
    Result<> link_estop_chain();

    MachineParts parts_;
    hal::Host &host_;
    hal::script::ProgramHost *programs_;
    mailbox::Memory mailbox_;  ///< must outlive its clients
    std::optional<client::Client> client_;
    io::Pins io_pins_;
    IniPins ini_pins_;
    halui::Halui halui_;
    ManualToolChange tool_change_;
    IniParameters parameters_;
    std::unique_ptr<journal::Writer> journal_;  ///< must outlive its users
    std::unique_ptr<task::ToolStore> tools_;
    bool lasting_ = false;
    motion::Channels *channels_ = nullptr;
    std::unique_ptr<task::Task> task_;
};

}  // namespace mw::machine
