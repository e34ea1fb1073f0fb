// SPDX-License-Identifier: GPL-2.0-or-later
// Messages between client and realtime process: lists of texts over a local stream socket.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::hal {

using Message = std::vector<std::string>;

inline constexpr std::size_t LONGEST_MESSAGE = 1U << 20U;

/// A count of bytes, then a count and the bytes of each text; counts are 32 bits in native byte order.
std::string encode(const Message &message);

/// Removes one message from the front of `buffer`; false when it is incomplete, an error when it is not
/// valid.
Result<bool> decode(std::string &buffer, Message &message);

/// Sends the whole message; false when the other side has disconnected. [blocks]
bool isSent(int fd, const Message &message);

/// Waits for one message; an error when the other side has disconnected. [blocks]
Result<Message> receive(int fd);

/// Path of the socket, and of the lock of an instance.
Result<std::string> socket_path(const std::string &instance);
Result<std::string> lock_path(const std::string &instance);

/// Takes the lock of an instance, which the returned descriptor holds, to prevent other changes of the
/// instance. -1 when another process has it. Remove the file (drop_lock) at the end.
Result<int> take_lock(const std::string &instance);
/// Removes the lock file and releases the lock.
void drop_lock(const std::string &instance, int fd);
/// True while a process holds the lock; creates no file.
bool isLockTaken(const std::string &instance);

}  // namespace mw::hal
