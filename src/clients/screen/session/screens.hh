// SPDX-License-Identifier: GPL-2.0-or-later
// All open screens, and the machine of which they are clients: the protocol of /api/socket.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clients/screen/session/browser.hh"

namespace mw::screen {

struct ScreensSetup {
    /// Creates a client of the machine; an error contains the reason. Called for each screen, and once for
    /// all screens.
    std::function<Result<client::Client>()> connect;
    /// As above for the shared client, through which a screen without a slot stops the machine; empty: as
    /// `connect`.
    std::function<Result<client::Client>()> connect_for_all{};
    std::string version;
    /// Note for screens of the role STATUS.
    std::string status_note{};
    std::int64_t status_period_ns = 50000000;
};

/// All methods are called by one thread, which passes the monotonic time.
class Screens {
  public:
    /// Interval of checks for a machine, and whether it is alive.
    static constexpr std::int64_t LOOK_NS = 250000000;
    /// Number of messages that a new screen receives.
    static constexpr std::size_t MOST_KEPT = 100;

    Screens(Sockets &sockets, ScreensSetup setup);

    void opened(SessionId session, const Rights &rights, std::int64_t now_ns);
    void received(SessionId session, std::string_view text, std::int64_t now_ns);
    void closed(SessionId session);
    /// Call it every few milliseconds.
    void tick(std::int64_t now_ns);

    /// Adds a line to the log, for example "ERROR: joint 0 following error". `age_ns` is the age of the
    /// message.
    using Log = std::function<void(std::string line, std::int64_t age_ns)>;
    void keep_log(Log log) { log_ = std::move(log); }

    bool isLogKept() const { return log_ != nullptr; }

    /// HAL names that the screens show, each once.
    std::vector<std::string> watched() const;
    /// Questions of HAL to operators; sent when they change, and to each new screen.
    void tell_questions(const std::string &questions);
    void tell_note(const std::string &note);
    void tell_values(const std::map<std::string, std::string> &values);

    bool isMachineUp() const { return watch_.has_value(); }
    std::size_t count() const { return browsers_.size(); }
    const Counts &counts() const { return counts_; }
    /// The last status; null if there is none.
    const messages::MachineStatus *status() const;
    /// The newest table; an error if there is none.
    Result<messages::ToolTable> tools();

  private:
    void look_for_machine();
    void lose_machine(const std::string &reason);
    /// Makes a browser a client of the machine; false if no slot is free.
    bool join(Browser &browser);
    void pass_messages();
    void tell_statuses(bool is_due);
    void tell_silence();
    void tell_all(const std::string &text);
    void log(const std::string &line, std::int64_t age_ns = 0) const;

    Sockets &sockets_;
    ScreensSetup setup_;
    std::string session_;                           ///< identifies this server; changes with a restart
    std::optional<client::Client> watch_;           ///< reads status and messages for all screens
    std::string reason_ = "no machine is running";  ///< reason why there is no machine
    bool has_status_ = false;
    std::uint64_t last_cycle_ = 0;              ///< task cycle of the last read
    std::int64_t last_advance_ns_ = 0;          ///< time when this cycle was new
    std::int64_t silence_told_ns_ = 0;          ///< 0: task is not silent
    std::optional<messages::ToolTable> tools_;  ///< the last tool table
    std::map<SessionId, std::unique_ptr<Browser>> browsers_;
    /// A message or note, and its time.
    struct Kept {
        std::string text;
        std::int64_t at_ns = 0;
    };

    /// Stores it for screens that connect later.
    void keep(const std::string &text, std::int64_t at_ns);

    std::deque<Kept> kept_;
    std::int64_t now_ns_ = 0;       ///< time of the last tick
    std::string questions_ = "[]";  ///< questions of HAL, JSON
    Log log_;
    Counts counts_;
    std::int64_t next_look_ns_ = 0, next_status_ns_ = 0;
};

}  // namespace mw::screen
