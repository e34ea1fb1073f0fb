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
    std::string received;     ///< time when it reached this computer
    std::int64_t late_s = 0;  ///< age of the value when the machine sent it
    bool isOver = false;      ///< the value has changed again
};
/// A value above this age is late. A publisher retries a broker after at most half a minute.
inline constexpr std::int64_t LATE_S = 60;

/// Header and body, with line ends for SMTP. `date` in the format of RFC 5322.
std::string mail_text(const NotifierSettings &settings, const Notification &what, const std::string &date);
std::string webhook_text(const Notification &what);

/// A thread that reads notifications from the database. Each is sent once to each target; failed ones are
/// retried for a day. A kill between sending and storing the result sends it twice.
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
    std::string trouble_;  ///< the last reported problem
    std::thread thread_;
};

}  // namespace mw::shop
