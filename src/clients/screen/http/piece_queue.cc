// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/http/piece_queue.hh"

#include <utility>

namespace mw::screen {

bool PieceQueue::push(std::string piece) {
    std::function<void()> wake;
    {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [this] { return isCancelled_ || bytes_ < MOST_WAITING; });
        if (isCancelled_) {
            return false;
        }
        bytes_ += piece.size();
        pieces_.push_back(std::move(piece));
        wake = std::exchange(wake_, nullptr);
    }
    if (wake) {
        wake();
    }
    return true;
}

void PieceQueue::end() {
    std::function<void()> wake;
    {
        const std::lock_guard lock(mutex_);
        isEnded_ = true;
        wake = std::exchange(wake_, nullptr);
    }
    if (wake) {
        wake();
    }
}

bool PieceQueue::hasRoom() const {
    const std::lock_guard lock(mutex_);
    return isCancelled_ || bytes_ < MOST_WAITING;
}

bool PieceQueue::isCancelled() const {
    const std::lock_guard lock(mutex_);
    return isCancelled_;
}

PieceQueue::State PieceQueue::take(std::string &piece, std::function<void()> wake) {
    const std::lock_guard lock(mutex_);
    if (pieces_.empty()) {
        wake_ = isEnded_ ? nullptr : std::move(wake);
        return isEnded_ ? State::END : State::LATER;
    }
    piece = std::move(pieces_.front());
    pieces_.pop_front();
    bytes_ -= piece.size();
    room_.notify_one();
    return State::PIECE;
}

void PieceQueue::cancel() {
    std::function<void()> unused;  // destroyed without the lock, because it may own the sender
    const std::lock_guard lock(mutex_);
    isCancelled_ = true;
    std::swap(unused, wake_);
    room_.notify_one();
}

}  // namespace mw::screen
