// SPDX-License-Identifier: GPL-2.0-or-later
// A body that one thread creates in pieces and another thread sends, in bounded memory.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>

namespace mw::screen {

class PieceQueue {
  public:
    /// Maximum number of bytes that wait to be sent; a single piece may be larger.
    static constexpr std::size_t MOST_WAITING = 4UL * 1024 * 1024;
    enum class State { PIECE, LATER, END };

    // --- for the creating thread

    /// Sleeps while too many data wait. False if the reader has left, so that no further piece is needed.
    bool push(std::string piece);
    /// True if push() would not sleep now.
    bool hasRoom() const;
    /// There are no more pieces.
    void end();
    bool isCancelled() const;

    // --- for the sending thread

    /// PIECE: the next piece is in `piece`. LATER: `wake` will be called, in the creating thread, when there
    /// is more.
    State take(std::string &piece, std::function<void()> wake);
    /// Called when the reader has left.
    void cancel();

  private:
    mutable std::mutex mutex_;
    std::condition_variable room_;
    std::deque<std::string> pieces_;
    std::size_t bytes_ = 0;
    bool isEnded_ = false, isCancelled_ = false;
    std::function<void()> wake_;
};

}  // namespace mw::screen
