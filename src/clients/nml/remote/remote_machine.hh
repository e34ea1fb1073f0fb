// SPDX-License-Identifier: GPL-2.0-or-later
// A machine on a remote computer, through its NML server. It has a mailbox in this process for the clients of
// this process.
#pragma once

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "clients/nml/bridge/channel.hh"
#include "messages/client/machine_link.hh"
#include "messages/declarations/joint_commands.hh"
#include "messages/mailbox/command_server.hh"
#include "messages/mailbox/memory.hh"

namespace mw::nml {

/// A thread sends the commands in their order, reads status, messages and tool table, and publishes them. An
/// error ends the connection: commands that have not ended fail, nothing is repeated, and check() returns the
/// reason.
class RemoteMachine final : public client::MachineLink {
  public:
    /// Waits for the status of the machine, at most for the time limits of the network. The serial numbers of
    /// its clients begin after `serial`. An error names the host and the problem.
    static Result<std::shared_ptr<RemoteMachine>> connect(Config config, const std::string &process,
                                                          mailbox::Serial serial);
    ~RemoteMachine() override;

    mailbox::Segment &segment() override { return memory_.segment(); }
    Result<> check() const override;
    void command_posted() override;
    void request_messages() override { are_messages_requested_.store(true); }
    Result<> check_tools() const override;

  private:
    /// A continuous jog of a client that has not set a lease. It gets a lease here, so that it stops when the
    /// network fails.
    struct Jog {
        messages::JogContinuous command;
        std::int64_t renewed_ns = 0;
        WriteNumber number = 0;  ///< number of the last renewal
    };

    RemoteMachine(Config config, std::string process);
    Result<> open();
    Result<> wait_first_status();
    void run();
    Result<> step();
    Result<> send_commands();
    Result<WriteNumber> send(messages::Command &command);
    Result<> send_renewals();
    void note_jog(messages::Command &command);
    /// True if there was a newer status.
    Result<bool> read_status();
    void follow(const StatusHead &head);
    Result<> read_messages();
    Result<> read_tools();
    void publish(messages::MachineStatus status);
    void lose(const Error &error);

    Config config_;
    std::string process_, server_;
    Vocabulary vocabulary_ = Vocabulary::standard();
    LocalPlaces local_;
    mailbox::Memory memory_ = mailbox::Memory::in_process();
    mailbox::CommandServer desk_{memory_.segment(), mailbox::CommandServer::Rights::DELIVERED};
    std::optional<Channel> commands_, statuses_, errors_, tools_;
    std::map<WriteNumber, mailbox::Serial> pending_;  ///< commands that have not ended
    std::vector<Jog> jogs_;
    mailbox::Serial taken_ = 0;
    std::uint64_t cycles_ = 0, tools_version_ = 0;

    std::atomic<bool> are_messages_requested_{false}, is_ending_{false};
    std::atomic<std::int64_t> status_ns_{0};  ///< time of the last status
    mutable std::mutex mutex_;                ///< guards the members below
    std::condition_variable wake_;
    bool is_posted_ = false;
    std::optional<Error> lost_;
    std::thread thread_;
};

}  // namespace mw::nml
