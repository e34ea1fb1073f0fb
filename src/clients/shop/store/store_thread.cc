// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/shop/store/store_thread.hh"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace mw::shop {
namespace {

constexpr std::chrono::seconds RETRY{1};
constexpr std::chrono::hours TEND{1};

}  // namespace

StoreThread::StoreThread(StoreSettings settings, Report report)
    : settings_(std::move(settings)), report_(std::move(report)), thread_([this] { run(); }) {}

StoreThread::~StoreThread() {
    {
        const std::lock_guard lock(mutex_);
        isEnded_ = true;
    }
    change_.notify_all();
    thread_.join();
}

StoreThread::State StoreThread::state() const {
    const std::lock_guard lock(mutex_);
    return state_;
}

int StoreThread::opened() const {
    const std::lock_guard lock(mutex_);
    return opened_;
}

void StoreThread::give(Batch batch) {
    {
        const std::lock_guard lock(mutex_);
        std::ranges::move(batch.new_series, std::back_inserter(new_series_));
        given_ = std::move(batch);
        state_ = State::BUSY;
    }
    change_.notify_all();
}

std::optional<std::vector<NodeReceipt>> StoreThread::take_stored() {
    const std::lock_guard lock(mutex_);
    return std::exchange(stored_, std::nullopt);
}

void StoreThread::set_trouble(const std::string &what) {
    if (what != std::exchange(trouble_, what) && !what.empty()) {
        report_(fmt::format("The machines store their values: {}.", what));
    }
}

/// Writes batches while the store works.
void StoreThread::write(Store &store, std::unique_lock<std::mutex> &lock) {
    auto tended = std::chrono::steady_clock::now();
    while (!isEnded_) {
        if (!given_.has_value()) {
            change_.wait_for(lock, RETRY);
        }
        const bool isDue = std::chrono::steady_clock::now() - tended >= TEND;
        if (!given_.has_value() && !isDue) {
            continue;
        }
        const Batch batch = std::exchange(given_, std::nullopt).value_or(Batch{});
        std::ranges::move(std::exchange(new_series_, {}), std::back_inserter(series_));
        lock.unlock();
        auto done = store.store(batch, series_);
        if (done.has_value() && isDue) {
            tended = std::chrono::steady_clock::now();
            done = store.tend();
        }
        lock.lock();
        if (!done.has_value()) {
            set_trouble(done.error().message);
            return;
        }
        if (state_ == State::BUSY && !given_.has_value()) {
            stored_ = batch.receipts;
            state_ = State::IDLE;
        }
    }
}

void StoreThread::run() {
    std::unique_lock lock(mutex_);
    while (!isEnded_) {
        lock.unlock();
        auto store = Store::open(settings_);
        lock.lock();
        if (!store.has_value()) {
            set_trouble(store.error().message);
            change_.wait_for(lock, RETRY, [this] { return isEnded_; });
            continue;
        }
        if (!trouble_.empty()) {
            report_("The database answers again.");
        }
        set_trouble("");
        given_.reset();
        stored_.reset();
        ++opened_;
        state_ = State::IDLE;
        write(*store, lock);
        state_ = State::AWAY;
    }
}

}  // namespace mw::shop
