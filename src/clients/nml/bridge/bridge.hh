// SPDX-License-Identifier: GPL-2.0-or-later
// Connects the channels emcCommand, emcStatus and emcError with the mailbox of a machine, as a client of that
// machine.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>

#include "clients/nml/bridge/channel.hh"
#include "messages/client/client.hh"
#include "messages/declarations/command.hh"

namespace mw::nml {

/// For one thread.
class Bridge {
  public:
    using Clock = std::chrono::steady_clock;
    /// Below the time without a status after which a remote client reports a failure.
    static constexpr std::chrono::milliseconds STALL_LIMIT{2500};

    /// `client` must outlive the bridge. The buffers must exist. Commands that already wait are dropped and
    /// reported, because they were sent to an earlier machine.
    static Result<std::unique_ptr<Bridge>> open(const Connections &connections, client::Client &client);

    /// Passes all data since the last step: commands in their order, then a newer status, then messages for
    /// the operator. Invalid messages and values out of range are rejected, with the reason on emcError and
    /// in the status. After a pause of more than STALL_LIMIT since the last step, waiting commands except
    /// stops are rejected, because remote clients have reported a failure by then. An error: a channel cannot
    /// be used now; the next step tries again.
    Result<> step(Clock::time_point now = Clock::now());

    /// Adds commands of the server itself, which are executed after all commands received before.
    void add(std::vector<messages::Command> commands);

  private:
    /// Commands in the `recent` list of the status whose end the mailbox has not reported; 0 for other
    /// entries.
    using Posted = std::array<client::Serial, RECENT_COMMANDS>;
    /// A command for which the mailbox had no space.
    struct Held {
        messages::Command command;
        StatusHead head;
    };

    Bridge(Channel commands, Channel status, Channel errors, client::Client &client);
    Result<> drop_old_commands();
    Result<> take_commands();
    void post_own();
    Result<std::optional<Held>> next_command();
    /// False: the command waits for space.
    bool post(const Held &held);
    void refuse(StatusHead head, const std::string &reason);
    /// Moves commands out of `waiting_`, so that a status never reports a command that its body does not
    /// include.
    void note_taken();
    /// Stores the command as the last one and among the recent ones, where it replaces the oldest command
    /// that has ended.
    void note(const StatusHead &head, client::Serial posted);
    void follow();
    Result<> publish();
    Result<> publish_tools();
    Result<> tell_messages();
    void keep_message(messages::MessageKind kind, std::uint64_t number, const std::string &text);

    Channel commands_, statuses_, errors_;
    client::Client &client_;
    std::optional<Channel> tools_;  ///< if the configuration has this channel
    /// A command that task has not taken, or has taken after the cycle of the last status.
    struct Waiting {
        StatusHead head;
        client::Serial posted = 0;  ///< 0: rejected here
    };
    std::deque<Waiting> waiting_;
    StatusHead head_;
    Posted posted_{};
    bool head_new_ = true;
    std::optional<Clock::time_point> last_step_;
    bool is_late_ = false;  ///< commands that waited during a pause may be in the channel
    std::uint64_t published_cycle_ = 0;
    std::optional<Held> held_;
    std::vector<messages::Command> own_;
    bool emptied_ = false;  ///< the channel was emptied in this step
    std::unique_ptr<StatusMessage<messages::MachineStatus>> status_;
    std::optional<StatusMessage<messages::ToolTable>> table_;  ///< status that is not written yet
    struct Line {
        messages::MessageKind kind;
        std::uint64_t number;
        std::string text;
    };
    std::deque<Line> lines_;  ///< lines for which emcError had no space
    std::uint64_t lost_lines_ = 0;
};

/// The names of the channels.
inline constexpr const char *COMMAND_CHANNEL = "emcCommand";
inline constexpr const char *STATUS_CHANNEL = "emcStatus";
inline constexpr const char *ERROR_CHANNEL = "emcError";
/// The tool table for remote clients; optional.
inline constexpr const char *TOOL_CHANNEL = "emcTools";

}  // namespace mw::nml
