// SPDX-License-Identifier: GPL-2.0-or-later
// A body that one thread makes piece by piece and another sends, in bounded memory.
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
    /// Bytes that may wait to be sent; a single piece may be larger.
    static constexpr std::size_t MOST_WAITING = 4UL * 1024 * 1024;
    enum class State { PIECE, LATER, END };

    // Of the maker's thread.

    /// Sleeps while too much waits. False: the reader has gone, and no further piece is needed.
    bool push(std::string piece);
    /// push() would not sleep now.
    bool hasRoom() const;
    /// There are no more.
    void end();
    bool isCancelled() const;

    // Of the sender's thread.

    /// PIECE: the next one is in `piece`. LATER: `wake` is called, in the maker's thread, when there is more.
    State take(std::string &piece, std::function<void()> wake);
    /// The reader has gone.
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
