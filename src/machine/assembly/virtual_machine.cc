// SPDX-License-Identifier: GPL-2.0-or-later
// The whole machine in one process under the virtual clock.
#include <cstdlib>
#include <filesystem>

#include "hal/core/crash_report.hh"
#include "hal/core/host.hh"
#include "machine/assembly/machine.hh"
#include "machine/assembly/task_side.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::machine {
namespace {

/// Maximum number of cycles until the motion controller has accepted its settings.
constexpr int CONFIGURE_CYCLES = 1000;

class VirtualMachine final : public Machine {
  public:
    explicit VirtualMachine(const MachineParts &parts) : parts_(parts) {}
    ~VirtualMachine() override {
        // The task side ends first, because its pins are in the host's instance and its periodic runs it.
        if (periodic_.value != 0) {
            scheduler_.remove(periodic_);
        }
        side_.reset();
        host_.reset();
    }

    Result<> start(const MachineOptions &options) {
        hal::InstanceOptions hal_options;
        hal_options.scheduler = &scheduler_;
        auto host = hal::LocalHost::create(hal_options);
        if (!host.has_value()) {
            return std::unexpected(host.error());
        }
        host_ = std::move(*host);
        side_ = std::make_unique<TaskSide>(parts_, *host_, mailbox::Memory::in_process(), nullptr);
        const hal::UseInstance use(&host_->hal());
        // Components run in this process, so their crash ends it.
        hal::report_crashes("millwright");
        MachineOptions mine = options;
        mine.clock_virtual = true;
        const auto started = side_->start(mine);
        if (!started.has_value()) {
            return started;
        }
        const auto periodic = scheduler_.add(
            {"task", parts_.config.task_period_ns, runtime::Order::TASK,
             [](void *self, std::int64_t) { static_cast<VirtualMachine *>(self)->task_cycle(); }, this});
        if (!periodic.has_value()) {
            return std::unexpected(periodic.error());
        }
        periodic_ = *periodic;
        return side_->finish_start(*this, CONFIGURE_CYCLES);
    }

    void cycle() override {
        const std::uint64_t before = cycles_;
        while (cycles_ == before) {
            scheduler_.step();
        }
    }
    std::int64_t now_ns() const override { return scheduler_.now_ns(); }
    bool isVirtual() const override { return true; }
    RealtimeFigures realtime_figures() const override { return {}; }
    client::Client &client() override { return side_->client(); }
    mailbox::Segment &mailbox() override { return side_->mailbox(); }
    task::Task &task() override { return side_->task(); }
    motion::Channels &channels() override { return side_->channels(); }
    hal::Instance &hal() override { return host_->hal(); }

  private:
    void task_cycle() {
        side_->step(scheduler_.now_ns());
        ++cycles_;
    }

    MachineParts parts_;
    runtime::VirtualScheduler scheduler_;
    std::unique_ptr<hal::LocalHost> host_;
    std::unique_ptr<TaskSide> side_;
    runtime::PeriodicId periodic_{};
    std::uint64_t cycles_ = 0;
};

}  // namespace

Result<std::unique_ptr<Machine>> make_virtual_machine(const MachineParts &parts,
                                                      const MachineOptions &options) {
    // Components read the folder of a configuration from CONFIG_DIR, as with LinuxCNC.
    std::error_code unknown;
    const auto ini = std::filesystem::absolute(parts.ini.path(), unknown);
    ::setenv("CONFIG_DIR", ini.parent_path().c_str(), 1);
    auto machine = std::make_unique<VirtualMachine>(parts);
    const auto started = machine->start(options);
    if (!started.has_value()) {
        return std::unexpected(started.error());
    }
    return machine;
}

}  // namespace mw::machine
