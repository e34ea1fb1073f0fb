// SPDX-License-Identifier: GPL-2.0-or-later
// The machine that runs a program: created in this process, or running in another process.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "machine/assembly/machine.hh"
#include "messages/client/client.hh"

namespace mw::programs {

/// All calls come from one thread.
class MachineAccess {
  public:
    virtual ~MachineAccess() = default;

    /// Runs a task cycle, or waits for the next one.
    virtual void cycle() = 0;
    virtual std::int64_t now_ns() const = 0;
    /// An error when the machine cannot continue. Check in every cycle.
    virtual Result<> health() const = 0;
    virtual client::Client &client() = 0;
    /// True if other clients may also operate the machine.
    virtual bool isShared() const = 0;
};

class OwnMachine final : public MachineAccess {
  public:
    explicit OwnMachine(machine::Machine &machine) : machine_(machine) {}

    void cycle() override { machine_.cycle(); }
    std::int64_t now_ns() const override { return machine_.now_ns(); }
    Result<> health() const override { return machine_.health(); }
    client::Client &client() override { return machine_.client(); }
    bool isShared() const override { return false; }

  private:
    machine::Machine &machine_;
};

/// A machine that `millwright start` keeps running. Actions of this client are aborted when the client ends
/// for any reason.
class RunningMachine final : public MachineAccess {
  public:
    /// Null if no machine of that instance runs. An error if the running machine cannot be joined, because it
    /// was started from another file than `ini` or ends with its own program.
    static Result<std::unique_ptr<RunningMachine>> find(const std::string &instance, const std::string &ini);
    ~RunningMachine() override;

    /// Requests the exclusive right to operate and renews it in each cycle, until give_back(). Rejected while
    /// something runs or moves, or another client has the right.
    Result<> take_over();
    void give_back();

    void cycle() override;
    std::int64_t now_ns() const override;
    Result<> health() const override;
    client::Client &client() override { return client_; }
    bool isShared() const override { return true; }

  private:
    explicit RunningMachine(client::Client client) : client_(std::move(client)) {}
    Result<> check_idle();
    Result<> ask(const messages::Command &command);

    client::Client client_;
    bool gone_ = false;
    bool operate_right_owned_ = false;
    std::int64_t renewed_ns_ = 0;
};

/// Aborts all work and waits until the machine is stopped.
void stop_motion(MachineAccess &machine);
/// Pauses the program, so that the axes stop with the spindle on; then stops as stop_motion(), and opens the
/// e-stop chain, which switches spindles, coolant and amplifiers off.
void switch_off(MachineAccess &machine);

}  // namespace mw::programs
