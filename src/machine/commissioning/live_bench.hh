// SPDX-License-Identifier: GPL-2.0-or-later
// The bench for a machine in this process or in its realtime process. Commands go through its client, single
// drives through its HAL.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "hal/core/instance.hh"
#include "machine/commissioning/bench.hh"
#include "messages/client/client.hh"

namespace mw::commissioning {

/// HAL commands that add a watchdog to the servo thread. If a program does not call update() of its bench in
/// time, the machine is switched off.
std::vector<std::string> watchdog_commands();

/// All calls come from one thread. Call update() in each task cycle before the guide. The machine must have
/// run watchdog_commands().
class LiveBench final : public Bench {
  public:
    LiveBench(client::Client &client, hal::Instance &hal, int joints);

    void update();

    double now_s() const override;
    bool isOn() const override;
    bool isEstopReleased() const override;
    bool isProbeOn() const override;
    JointReading joint(int joint) const override;
    std::uint64_t late_cycles() const override;
    double worst_latency_s() const override;
    std::string last_error() const override { return last_error_; }

    void switch_on(const std::vector<int> &joints) override;
    void switch_off() override;
    void move_to(int joint, double position, double speed) override;
    void stop(int joint) override;
    void home(int joint) override;
    void unhome(int joint) override;
    void run_spindle(double speed_rpm) override;
    void stop_spindle() override;

    std::optional<double> value(std::string_view name) const override;
    void set_value(std::string_view name, double value) override;

  private:
    /// An input of a drive that was unlinked from its signal.
    struct Gate {
        int joint = 0;
        std::string pin, signal;
    };
    bool isHomeSwitchOn(int joint) const;
    Result<> close_gate(int joint);
    Result<> open_gates();
    Result<> close_gates_except(const std::vector<int> &joints);
    bool hasWatchdog() const { return watchdog_beat_ != nullptr && watchdog_enable_ != nullptr; }
    void reject(std::string why);
    /// Posts a command at once and drops waiting commands.
    void post(const messages::Command &command);
    /// Posts the next waiting command when the previous one has succeeded.
    void post_waiting();
    /// Address of a HAL bit; null if it does not exist.
    volatile bool *find_bit(const std::string &name);

    client::Client &client_;
    hal::Instance &hal_;
    int joints_;
    std::vector<Gate> gates_;
    std::deque<messages::Command> waiting_;
    std::optional<client::Serial> posted_;
    volatile const bool *estop_ = nullptr, *probe_ = nullptr;
    std::vector<volatile const bool *> home_switches_;
    std::string last_error_;
    int homing_joint_ = NO_JOINT;
    bool isRestartingWatchdog_ = false;
    volatile bool *watchdog_beat_ = nullptr, *watchdog_enable_ = nullptr;
};

}  // namespace mw::commissioning
