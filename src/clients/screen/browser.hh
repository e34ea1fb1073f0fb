// SPDX-License-Identifier: GPL-2.0-or-later
// One open screen as the machine's client: its commands with their outcomes, its jogs, and the last status
// that it has.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clients/screen/documents.hh"
#include "clients/screen/lateness.hh"
#include "clients/screen/origin_check.hh"
#include "clients/screen/status_delta.hh"
#include "messages/client/client.hh"

namespace mw::screen {

/// Counts for /metrics.
struct Counts {
    std::uint64_t commands = 0, stops = 0, refused = 0, statuses = 0, messages = 0;
};

/// Stops what it jogs when it ends. One thread; time is passed in.
class Browser {
  public:
    using Send = std::function<void(std::string)>;
    /// Commands per second; a stop is none of them.
    static constexpr double COMMANDS_PER_S = 200, COMMANDS_AT_ONCE = 200;
    /// Commands whose outcome is followed; a further stop is still executed.
    static constexpr std::size_t MOST_FOLLOWED = 60;
    /// A command that has not ended by then is reported as STARTED.
    static constexpr std::int64_t SOON_NS = 50000000;
    static const char *const ONLY_STOPS;  ///< why other commands of a screen without a slot are rejected
    /// DONE does not wait longer for a status: none is read when task is silent.
    static constexpr std::int64_t LONGEST_WAIT_NS = 300000000;
    /// A browser that says nothing for so long is gone.
    static constexpr std::int64_t SILENCE_NS = 5000000000;

    Browser(Send send, Counts &counts, Role role, std::int64_t now_ns)
        : send_(std::move(send)), counts_(counts), role_(role), heard_ns_(now_ns) {}
    ~Browser() { stop_jogs(); }
    Browser(const Browser &) = delete;
    Browser &operator=(const Browser &) = delete;

    /// The machine is running.
    void join(client::Client client) {
        client_.emplace(std::move(client));
        if (role_ < Role::CONFIGURE) {
            client_->limit_authority(mailbox::Authority::OPERATE);
        }
    }
    /// The machine is running: `shared` takes stops while this screen has no slot. It outlives
    /// leave().
    void attach(client::Client &shared) { shared_ = &shared; }
    bool isAttached() const { return shared_ != nullptr; }
    /// The next status is a whole one.
    void forget_status() { has_whole_ = false; }
    /// The machine has ended: all open requests have failed.
    void leave();
    bool isJoined() const { return client_.has_value(); }
    /// Number in the mailbox, 0 without a machine.
    std::uint32_t number() const { return client_.has_value() ? client_->id() : 0; }

    /// A text from its socket. A stop is posted at once.
    void receive(std::string_view text, std::int64_t now_ns);
    /// Sends the outcomes that are new; DONE behind the status of a later cycle of task, which shows the
    /// effect. That of a stop is sent at once.
    void follow(std::int64_t now_ns);
    /// A command is done, and the status that shows its effect was not sent yet.
    bool isWaitingForStatus() const;
    /// Parts of the status that were read are sent with the next one.
    void note_read(PartMask parts) { unread_ |= parts; }
    /// The whole at first, then what has changed; nothing when nothing has.
    void tell_status(const messages::MachineStatus &status);
    void tell(std::string text) { send_(std::move(text)); }
    /// Names of HAL that it shows.
    const std::vector<std::string> &watched() const { return watched_; }
    /// Sends those of its names that are new or have changed.
    void tell_values(const std::map<std::string, std::string> &values);
    bool isSilent(std::int64_t now_ns) const { return now_ns - heard_ns_ > SILENCE_NS; }

    /// A joint or axis; that of a jog that this browser has begun.
    using Jogged = std::pair<bool, int>;
    const std::optional<Jogged> &begun() const { return begun_; }
    /// Another browser jogs it now.
    void give_up(const Jogged &what) { jogs_.erase(what); }

  private:
    struct Followed {
        std::uint64_t id = 0;
        client::Client *client = nullptr;  ///< through which it went; null: the screen's own
        client::Serial serial = 0;
        std::int64_t since_ns = 0;
        bool isStop = false;       ///< its outcome waits for no status
        bool isTold = false;       ///< as STARTED
        std::int64_t done_ns = 0;  ///< when it was seen as DONE; 0: not yet
        /// Of the first status that was read after it was seen as DONE.
        std::optional<std::uint64_t> done_cycle{};
        bool isShown = false;  ///< a status of a later cycle was sent
    };
    void note_shown(std::uint64_t cycle);
    bool isEffectShown(const Followed &one, std::int64_t now_ns) const;
    void carry_out(const Ask &ask, std::int64_t now_ns);
    /// A lease counts from when it was asked for. False: it is over already.
    bool shorten_lease(messages::Command &command, const Ask &ask, std::int64_t now_ns);
    void refuse(std::uint64_t id, std::string reason);
    void note_jog(const messages::Command &command);
    void stop_jogs();

    Send send_;
    Counts &counts_;
    Role role_;
    client::Client *shared_ = nullptr;
    std::optional<client::Client> client_;
    StatusDelta delta_;
    bool has_whole_ = false;
    PartMask unread_ = 0;
    std::vector<std::string> watched_;
    std::map<std::string, std::string> told_values_;
    std::deque<Followed> followed_;
    std::set<Jogged> jogs_;
    std::optional<Jogged> begun_;  ///< by the last text
    Lateness lateness_;
    RateLimit rate_{COMMANDS_PER_S, COMMANDS_AT_ONCE};
    std::int64_t heard_ns_;
};

}  // namespace mw::screen
