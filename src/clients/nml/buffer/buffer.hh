// SPDX-License-Identifier: GPL-2.0-or-later
// A connection to a local or remote buffer of messages (F1, F5).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"
#include "clients/nml/timeout.hh"

namespace mw::nml {

/// Number of a write among all writes to its buffer, from 1.
using WriteNumber = std::uint64_t;

struct Received {
    std::string bytes;
    WriteNumber number = 0;
};

/// Statistics of one process for a buffer with diagnostics.
struct AccessFigures {
    std::int32_t pid = 0;
    std::uint64_t writes = 0;
    std::uint64_t reads = 0;  ///< reads that returned a message
    std::uint64_t bytes_written = 0;
    std::uint64_t bytes_read = 0;
    std::int64_t last_access_ns = 0;   ///< CLOCK_MONOTONIC
    std::int64_t longest_wait_ns = 0;  ///< maximum wait for other users of the buffer
};

struct Rights {
    bool mayRead = true;
    bool mayWrite = true;
};

/// All calls come from one thread. An access may wait for other users of the buffer and for free space in a
/// queue; only wait() waits for a message. An error states what to do, or that the timeout has expired. The
/// connection is usable after an error, unless the error reports that the buffer no longer exists.
class Buffer {
  public:
    Buffer(std::string name, Rights rights) : name_(std::move(name)), rights_(rights) {}
    Buffer(const Buffer &) = delete;
    Buffer &operator=(const Buffer &) = delete;
    virtual ~Buffer() = default;

    const std::string &name() const { return name_; }
    Rights rights() const { return rights_; }

    /// Replaces the previous message; a queue appends the message.
    Result<WriteNumber> write(std::string_view bytes, Timeout timeout);
    /// The message that this connection has not read. From a queue the oldest message is removed. False:
    /// there is no message.
    Result<bool> read(Received &message, Timeout timeout);
    /// The message, also if it was read. The oldest message remains in a queue. False: there is no message.
    Result<bool> peek(Received &message, Timeout timeout);
    /// As read(), but sleeps until there is a message. False after the timeout.
    Result<bool> wait(Received &message, Timeout timeout);
    /// Removes all messages.
    Result<> clear(Timeout timeout);
    /// Empty if the buffer has no diagnostics.
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
