// SPDX-License-Identifier: GPL-2.0-or-later
// A whole machine in virtual time with several clients, a tool changer at its pins, and a disk that can lose
// unsynced data. It may be killed and restarted.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
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
#include "motion/interface/channels.hh"
#include "task_campaign/plan.hh"

namespace mw::task_campaign {

/// The reaction of the changer to its requests.
struct Changer {
    int answer_ms = 20;
    bool isFaulted = false;
};

class Bench {
  public:
    Bench(const Plan &plan, std::filesystem::path folder);
    ~Bench();

    /// Empty, or the error.
    std::string come_up();
    /// All data of the process are lost; with `isPowerCut` the disk loses unsynced data.
    void die(bool isPowerCut);
    bool isUp() const { return machine_ != nullptr; }
    /// A cycle of task, one millisecond.
    void cycle();
    std::int64_t now_ms() const { return now_ms_; }

    client::Client &client(int number) { return *clients_[static_cast<std::size_t>(number)]; }
    /// Ends the client as kill -9 does; another client replaces it.
    void lose_client(int number);
    const messages::MachineStatus &status() const { return machine_->task().status(); }
    machine::Machine &machine() { return *machine_; }

    /// State of the machine in HAL.
    struct Pins {
        volatile bool *chain, *is_amp_on, *spindle_on, *mist, *flood, *tool_prepare, *tool_change,
            *in_position;
        volatile bool *tool_prepared, *tool_changed, *fault, *at_speed;
        volatile double *speed_out;
        volatile std::int32_t *tool_number;
    };
    const Pins &pins() const { return pins_; }

    /// The parameter file on the disk, as the writer has written it.
    std::map<int, double> parameters() const;
    std::string tool_table() const;
    void write_tool_table(const std::vector<Tool> &tools) const;
    std::string write_program(const std::string &text);
    /// Executes all requests to the writer.
    void flush() { writer_->work(); }
    static constexpr int MOST_LATE_MS = 120;

    Changer changer;

  private:
    void write_files() const;
    void step_changer();
    void step_disk();
    std::string bind();
    std::string join(std::size_t number);

    Plan plan_;
    std::filesystem::path folder_;
    journal::test::TornDisk disk_;
    std::mt19937_64 random_;
    diagnostics::Sink sink_;
    std::unique_ptr<machine::LoadedConfig> loaded_;
    std::unique_ptr<journal::Writer> writer_;
    std::unique_ptr<machine::Machine> machine_;
    std::array<std::unique_ptr<client::Client>, CLIENTS> clients_;
    Pins pins_{};
    std::int64_t now_ms_ = 0;
    std::uint64_t programs_ended_ = 0;
    int late_ms_ = 0, asked_ms_ = 0;
};

}  // namespace mw::task_campaign
