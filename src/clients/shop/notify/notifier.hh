// SPDX-License-Identifier: GPL-2.0-or-later
// Sends notifications by mail and webhook.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/result.hh"
#include "clients/shop/store/database.hh"

namespace mw::shop {

struct NotifierSettings {
    std::string server, from, user, password;
    std::vector<std::string> to;        ///< mail addresses
    std::vector<std::string> webhooks;  ///< addresses

    bool isUsed() const { return !to.empty() || !webhooks.empty(); }
};

struct Notification {
    std::string id, machine, at, source, message;
    std::string received;     ///< when it came to this computer
    std::int64_t late_s = 0;  ///< age of the value when the machine sent it
    bool isOver = false;      ///< the value has changed since
};
/// A value that is older than that is late: a publisher tries a broker again after half a minute at most.
inline constexpr std::int64_t LATE_S = 60;

/// Header and body, with lines as SMTP requires them. `date` as RFC 5322 has it.
std::string mail_text(const NotifierSettings &settings, const Notification &what, const std::string &date);
std::string webhook_text(const Notification &what);

/// A thread that reads notifications from the database. Each is sent once to each target; what fails is tried
/// again for a day. A kill between the sending and the note of it sends it twice.
class Notifier {
  public:
    using Report = std::function<void(const std::string &)>;

    Notifier(std::string database, NotifierSettings settings, Report report);
    ~Notifier();
    Notifier(const Notifier &) = delete;
    Notifier &operator=(const Notifier &) = delete;

  private:
    void run();
    Result<> send_all(Database &database);
    Result<> send_to(Database &database, const std::string &target);
    Result<> send(const std::string &target, const Notification &what) const;
    bool wait(double seconds);

    std::string database_;
    NotifierSettings settings_;
    Report report_;
    std::mutex mutex_;
    std::condition_variable change_;
    bool isEnded_ = false;
    std::string trouble_;  ///< the last that was reported
    std::thread thread_;
};

}  // namespace mw::shop
