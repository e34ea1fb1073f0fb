// SPDX-License-Identifier: GPL-2.0-or-later
// The store in a separate thread: a database that is slow or away stops nothing else.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "clients/shop/store/store.hh"

namespace mw::shop {

/// Any thread, except that one thread gives and takes.
class StoreThread {
  public:
    using Report = std::function<void(const std::string &)>;

    StoreThread(StoreSettings settings, Report report);
    ~StoreThread();
    StoreThread(const StoreThread &) = delete;
    StoreThread &operator=(const StoreThread &) = delete;

    enum class State : std::uint8_t { AWAY, IDLE, BUSY };
    State state() const;
    /// Counts how often the store was opened: what was given before and not stored is gone.
    int opened() const;
    /// In the state IDLE. Series are kept also while the store is away.
    void give(Batch batch);
    /// Receipts of a batch that is stored.
    std::optional<std::vector<NodeReceipt>> take_stored();

  private:
    void run();
    void write(Store &store, std::unique_lock<std::mutex> &lock);
    void set_trouble(const std::string &what);

    StoreSettings settings_;
    Report report_;
    mutable std::mutex mutex_;
    std::condition_variable change_;
    bool isEnded_ = false;
    State state_ = State::AWAY;
    int opened_ = 0;
    std::vector<Series> series_;      ///< of the thread
    std::vector<Series> new_series_;  ///< not yet among series_
    std::optional<Batch> given_;
    std::optional<std::vector<NodeReceipt>> stored_;
    std::string trouble_;  ///< the last that was reported
    std::thread thread_;
};

}  // namespace mw::shop
