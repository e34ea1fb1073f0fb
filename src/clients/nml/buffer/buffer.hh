// SPDX-License-Identifier: GPL-2.0-or-later
// A connection to a buffer of messages, wherever the buffer is (F1, F5).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "clients/nml/timeout.hh"

namespace mw::nml {

/// Which number a write has among all writes to its buffer, from 1.
using WriteNumber = std::uint64_t;

struct Received {
    std::string bytes;
    WriteNumber number = 0;
};

/// What one process has done with a buffer that is diagnosed.
struct AccessFigures {
    std::int32_t pid = 0;
    std::uint64_t writes = 0;
    std::uint64_t reads = 0;  ///< that brought a message
    std::uint64_t bytes_written = 0;
    std::uint64_t bytes_read = 0;
    std::int64_t last_access_ns = 0;   ///< CLOCK_MONOTONIC
    std::int64_t longest_wait_ns = 0;  ///< for others who used the buffer
};

struct Rights {
    bool mayRead = true;
    bool mayWrite = true;
};

/// One thread. An access may wait for other users of the buffer and for free space in a queue; wait() alone
/// waits for a message. An error states what to do, or that the time is over. After an error
/// the connection is as good as before, unless the error says that the buffer is gone.
class Buffer {
  public:
    Buffer(std::string name, Rights rights) : name_(std::move(name)), rights_(rights) {}
    Buffer(const Buffer &) = delete;
    Buffer &operator=(const Buffer &) = delete;
    virtual ~Buffer() = default;

    const std::string &name() const { return name_; }
    Rights rights() const { return rights_; }

    /// Puts a message in place of the one before; into a queue behind all others.
    Result<WriteNumber> write(std::string_view bytes, Timeout timeout);
    /// The message that this connection has not read; of a queue the oldest, which is taken out. False: there
    /// is none.
    Result<bool> read(Received &message, Timeout timeout);
    /// The message, read or not; of a queue the oldest, which stays. False: there is none.
    Result<bool> peek(Received &message, Timeout timeout);
    /// read(), sleeping until there is a message. False: the time was over first.
    Result<bool> wait(Received &message, Timeout timeout);
    /// Removes all messages.
    Result<> clear(Timeout timeout);
    /// Empty unless the buffer is diagnosed.
    virtual Result<std::vector<AccessFigures>> figures() { return std::vector<AccessFigures>{}; }

  protected:
    std::unexpected<Error> bad(const std::string &what, const std::string &hint = "") const;

  private:
    virtual Result<WriteNumber> put(std::string_view bytes, Timeout timeout) = 0;
    virtual Result<bool> take(Received &message, Timeout timeout) = 0;
    virtual Result<bool> look(Received &message, Timeout timeout) = 0;
    virtual Result<bool> take_next(Received &message, Timeout timeout) = 0;
    virtual Result<> empty(Timeout timeout) = 0;
    Result<> need_read() const;
    Result<> need_write() const;

    std::string name_;
    Rights rights_;
};

}  // namespace mw::nml
