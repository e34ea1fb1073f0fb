// SPDX-License-Identifier: GPL-2.0-or-later
// Between the channels emcCommand, emcStatus and emcError and the mailbox of a machine, of which it is a
// client like any other.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>

#include "clients/nml/bridge/channel.hh"
#include "messages/client/client.hh"
#include "messages/declarations/command.hh"

namespace mw::nml {

/// One thread.
class Bridge {
  public:
    using Clock = std::chrono::steady_clock;
    /// Less than the time without a status after which a remote client reports a failure.
    static constexpr std::chrono::milliseconds STALL_LIMIT{2500};

    /// `client` must outlive it. The buffers are there. Commands that wait already are dropped and
    /// reported: they were sent to an earlier machine.
    static Result<std::unique_ptr<Bridge>> open(const Connections &connections, client::Client &client);

    /// Passes everything since the last step: commands in their order, then the status when it is newer,
    /// then messages for the operator. Invalid messages and values out of range end here with their reason
    /// on emcError and in the status. After a pause of more than STALL_LIMIT since the last step, the
    /// commands that wait are rejected, except stops: remote clients have reported a failure by then. An
    /// error: a channel cannot be used now; the next step tries again.
    Result<> step(Clock::time_point now = Clock::now());

    /// Commands of the server itself, carried out after all that came in before.
    void add(std::vector<messages::Command> commands);

  private:
    /// Commands in the `recent` list of the status whose end the mailbox has not reported: 0 elsewhere.
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
    /// False: it waits for room.
    bool post(const Held &held);
    void refuse(StatusHead head, const std::string &reason);
    /// Moves commands out of `waiting_`: a status never reports a command that its body does not include.
    void note_taken();
    /// Makes the command the last one, and one of the recent ones: the oldest that has ended makes room.
    void note(const StatusHead &head, client::Serial posted);
    void follow();
    Result<> publish();
    Result<> publish_tools();
    Result<> tell_messages();
    void keep_message(messages::MessageKind kind, std::uint64_t number, const std::string &text);

    Channel commands_, statuses_, errors_;
    client::Client &client_;
    std::optional<Channel> tools_;  ///< where the configuration has it
    /// A command that task has not taken, or has taken in a later cycle than that of the last status.
    struct Waiting {
        StatusHead head;
        client::Serial posted = 0;  ///< 0: rejected here
    };
    std::deque<Waiting> waiting_;
    StatusHead head_;
    Posted posted_{};
    bool head_new_ = true;
    std::optional<Clock::time_point> last_step_;
    bool is_late_ = false;  ///< commands that waited through a pause may be in the channel
    std::uint64_t published_cycle_ = 0;
    std::optional<Held> held_;
    std::vector<messages::Command> own_;
    bool emptied_ = false;  ///< the channel, in this step
    std::unique_ptr<StatusMessage<messages::MachineStatus>> status_;
    std::optional<StatusMessage<messages::ToolTable>> table_;  ///< not written yet
    struct Line {
        messages::MessageKind kind;
        std::uint64_t number;
        std::string text;
    };
    std::deque<Line> lines_;  ///< for which emcError had no space
    std::uint64_t lost_lines_ = 0;
};

/// The names of the channels.
inline constexpr const char *COMMAND_CHANNEL = "emcCommand";
inline constexpr const char *STATUS_CHANNEL = "emcStatus";
inline constexpr const char *ERROR_CHANNEL = "emcError";
/// The tool table, for remote clients. Optional.
inline constexpr const char *TOOL_CHANNEL = "emcTools";

}  // namespace mw::nml
