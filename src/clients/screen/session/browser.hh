// SPDX-License-Identifier: GPL-2.0-or-later
// One open screen as a client of the machine: its commands with their outcomes, its jogs, and its last
// status.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "clients/screen/access/origin_check.hh"
#include "clients/screen/http/http_types.hh"
#include "clients/screen/session/lateness.hh"
#include "clients/screen/session/socket_texts.hh"
#include "clients/screen/status/status_delta.hh"
#include "messages/client/client.hh"

namespace mw::screen {

/// Counts for /metrics.
struct Counts {
    std::uint64_t commands = 0, stops = 0, refused = 0, statuses = 0, messages = 0;
};

/// Stops its jogs when it ends. One thread; the caller passes the time.
class Browser {
  public:
    using Send = std::function<void(std::string)>;
    /// Commands per second, without stops.
    static constexpr double COMMANDS_PER_S = 200, COMMANDS_AT_ONCE = 200;
    /// Number of commands whose outcome is followed; a further stop is still executed.
    static constexpr std::size_t MOST_FOLLOWED = 60;
    /// A command that has not ended after this time is reported as STARTED.
    static constexpr std::int64_t SOON_NS = 50000000;
    static const char *const ONLY_STOPS;  ///< reason why other commands of a screen without a slot are
                                          ///< rejected
    /// Maximum wait of DONE for a status, because none is read while task is silent.
    static constexpr std::int64_t LONGEST_WAIT_NS = 300000000;
    /// A browser without data for this time counts as disconnected.
    static constexpr std::int64_t SILENCE_NS = 5000000000;

    Browser(Send send, Counts &counts, Role role, std::int64_t now_ns)
        : send_(std::move(send)), counts_(counts), role_(role), heard_ns_(now_ns) {}
    ~Browser() { stop_jogs(); }
    Browser(const Browser &) = delete;
    Browser &operator=(const Browser &) = delete;

    /// Called when the machine is running.
    void join(client::Client client) {
        client_.emplace(std::move(client));
        if (role_ < Role::CONFIGURE) {
            client_->limit_authority(mailbox::Authority::OPERATE);
        }
    }
    /// Called when the machine is running and this screen has no slot: `shared` accepts its stops. It
    /// outlives leave().
    void attach(client::Client &shared) { shared_ = &shared; }
    bool isAttached() const { return shared_ != nullptr; }
    /// The next status is sent completely.
    void forget_status() { has_whole_ = false; }
    /// Called when the machine has ended: all open requests have failed.
    void leave();
    bool isJoined() const { return client_.has_value(); }
    /// Number in the mailbox, 0 without a machine.
    std::uint32_t number() const { return client_.has_value() ? client_->id() : 0; }

    /// Receives a text from the socket. A stop is posted at once.
    void receive(std::string_view text, std::int64_t now_ns);
    /// Sends new outcomes. DONE follows the status of a later cycle of task, which shows the effect; the
    /// outcome of a stop is sent at once.
    void follow(std::int64_t now_ns);
    /// True if a command is done and the status with its effect was not sent yet.
    bool isWaitingForStatus() const;
    /// Parts of the status that were read are sent with the next status.
    void note_read(PartMask parts) { unread_ |= parts; }
    /// Sends the complete status first, then changes; nothing if nothing has changed.
    void tell_status(const messages::MachineStatus &status);
    void tell(std::string text) { send_(std::move(text)); }
    /// HAL names that the screen shows.
    const std::vector<std::string> &watched() const { return watched_; }
    /// Sends the new or changed values of its names.
    void tell_values(const std::map<std::string, std::string> &values);
    bool isSilent(std::int64_t now_ns) const { return now_ns - heard_ns_ > SILENCE_NS; }

    /// The joint or axis of a jog that this browser has started.
    using Jogged = std::pair<bool, int>;
    const std::optional<Jogged> &begun() const { return begun_; }
    /// Called when another browser jogs it.
    void give_up(const Jogged &what) { jogs_.erase(what); }

  private:
    struct Followed {
        std::uint64_t id = 0;
        client::Client *client = nullptr;  ///< client that posted it; null: the screen's own client
        client::Serial serial = 0;
        std::int64_t since_ns = 0;
        bool isStop = false;       ///< its outcome does not wait for a status
        bool isTold = false;       ///< it was reported as STARTED
        std::int64_t done_ns = 0;  ///< time when it was seen as DONE; 0: not yet
        /// Cycle of the first status read after it was seen as DONE.
        std::optional<std::uint64_t> done_cycle{};
        bool isShown = false;  ///< a status of a later cycle was sent
    };
    void note_shown(std::uint64_t cycle);
    bool isEffectShown(const Followed &one, std::int64_t now_ns) const;
    void carry_out(const Ask &ask, std::int64_t now_ns);
    /// A lease begins at the time of the request. False if it has already expired.
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
    std::optional<Jogged> begun_;  ///< started by the last text
    Lateness lateness_;
    RateLimit rate_{COMMANDS_PER_S, COMMANDS_AT_ONCE};
    std::int64_t heard_ns_;
};

}  // namespace mw::screen
