// SPDX-License-Identifier: GPL-2.0-or-later
// The store in a separate thread, so that a slow or missing database does not block anything else.
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

/// Any thread, but only one thread calls give and take.
class StoreThread {
  public:
    using Report = std::function<void(const std::string &)>;

    StoreThread(StoreSettings settings, Report report);
    ~StoreThread();
    StoreThread(const StoreThread &) = delete;
    StoreThread &operator=(const StoreThread &) = delete;

    enum class State : std::uint8_t { AWAY, IDLE, BUSY };
    State state() const;
    /// Number of times the store was opened. Batches that were given before and not stored are lost.
    int opened() const;
    /// Call it in the state IDLE. Series are kept also while the store is unavailable.
    void give(Batch batch);
    /// Receipts of a stored batch.
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
    std::vector<Series> series_;      ///< used by the thread
    std::vector<Series> new_series_;  ///< not yet in series_
    std::optional<Batch> given_;
    std::optional<std::vector<NodeReceipt>> stored_;
    std::string trouble_;  ///< the last reported problem
    std::thread thread_;
};

}  // namespace mw::shop
