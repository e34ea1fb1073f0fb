// SPDX-License-Identifier: GPL-2.0-or-later
// A client of a machine: commands with their outcome, status, messages. The machine runs in this process or
// in another process.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "messages/client/viewer.hh"
#include "messages/mailbox/places.hh"

namespace mw::client {

using mailbox::Places;
using mailbox::Role;
using mailbox::Serial;

/// Progress of a command, or its result.
struct Outcome {
    messages::Progress progress = messages::Progress::STARTED;
    std::string reason;  ///< reason of a rejection or failure
};

/// For one thread. The destructor frees the client's slot; commands that it has started continue.
class Client {
  public:
    /// Connects to a machine in another process, by the name of its instance.
    static Result<Client> connect(const std::string &instance, Role role = Role::OPERATOR,
                                  Places places = Places::ORDINARY);
    /// Joins a machine in this process, which must outlive the client.
    static Result<Client> join(mailbox::Segment &segment, Role role = Role::OPERATOR,
                               Places places = Places::ORDINARY);
    /// Joins the machine of the viewer, on this computer or a remote computer.
    static Result<Client> join(Viewer viewer, Role role = Role::OPERATOR, Places places = Places::ORDINARY);
    ~Client();
    Client(Client &&other) noexcept;
    Client &operator=(Client &&other) noexcept;

    /// Reduces the authority of all further commands; it cannot be increased again. For programs that forward
    /// commands of other programs.
    void limit_authority(mailbox::Authority most);

    /// Number of this client, by which the right to operate identifies it.
    mailbox::ClientId id() const { return id_; }

    /// Posts a command and returns its number, which is unique among all clients. An error when a value is
    /// out of range or MAX_POSTED commands wait. A stop is always accepted.
    Result<Serial> post(const messages::Command &command);
    /// Progress of a command; STARTED also while it waits for task. A command that task no longer stores is
    /// reported as rejected, with this reason.
    Outcome outcome(Serial serial);
    /// Sleeps until the command ends; an error after the timeout or when the machine has ended.
    Result<Outcome> wait(Serial serial, double timeout_s);

    /// Sleeps until task has taken the command, before its outcome.
    Result<> wait_taken(Serial serial, double timeout_s);

    /// Sleeps until `isOver()`, as Viewer::wait_until.
    template <class IsOver>
    Result<> wait_until(const IsOver &isOver, double timeout_s) {
        return viewer_.wait_until(isOver, timeout_s);
    }

    // The client reads the machine as any viewer (messages/client/viewer.hh).
    using Message = Viewer::Message;
    mailbox::Identity identity() const { return viewer_.identity(); }
    bool isMachineAlive() const { return viewer_.isMachineAlive(); }
    Result<> check_machine() const { return viewer_.check_machine(); }
    Result<> read_status() { return viewer_.read_status(); }
    const messages::MachineStatus &status() const { return viewer_.status(); }
    PartMask fresh_parts() const { return viewer_.fresh_parts(); }
    Result<> wait_status(double timeout_s) { return viewer_.wait_status(timeout_s); }
    Result<std::optional<messages::ToolTable>> read_tools() { return viewer_.read_tools(); }
    std::optional<Message> next_message(Viewer::Reading reading = Viewer::Reading::COUNTS) {
        return viewer_.next_message(reading);
    }
    void rewind_messages(std::uint64_t most) { viewer_.rewind_messages(most); }
    std::uint64_t run() const { return viewer_.run(); }
    bool claim_log(std::uint64_t number) const { return viewer_.claim_log(number); }

  private:
    Client(Viewer viewer, int slot, mailbox::ClientId id);
    mailbox::Slot &slot() const { return viewer_.segment().slots[static_cast<std::size_t>(slot_)]; }
    void leave() noexcept;
    void announce() const;
    Serial post_stop(int place);
    bool isStopWaiting(Serial serial);
    bool isTaken(Serial serial);

    Viewer viewer_;
    bool hasPlace_ = true;  ///< false after a move
    int slot_ = 0;
    mailbox::ClientId id_ = 0;
    /// The outcome that was requested last, its position, and the number of outcomes reported at that time.
    struct Found {
        Serial serial = 0;
        std::uint64_t told = 0;
        std::size_t place = 0;
        Outcome outcome;
    } found_;
    struct PostedStop {
        Serial serial = 0;
        int place = 0;
    };
    std::vector<PostedStop> posted_stops_;  ///< stops beside the queue that task has not taken yet
    /// Stops replaced by a later stop of the same type: their number, and the number of the later stop.
    std::deque<std::pair<Serial, Serial>> replaced_stops_;
};

}  // namespace mw::client
