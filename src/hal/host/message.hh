// SPDX-License-Identifier: GPL-2.0-or-later
// What client and realtime process say to each other: lists of texts over a local stream socket.
#pragma once

#include <string>
#include <vector>

#include "base/result.hh"

namespace mw::hal {

using Message = std::vector<std::string>;

inline constexpr std::size_t LONGEST_MESSAGE = 1U << 20U;

/// A count of bytes, then a count and the bytes of each text; counts are 32 bits, in the machine's order.
std::string encode(const Message &message);

/// Takes one message from the front of `buffer`; false when it is not complete yet. An error when it cannot
/// be one.
Result<bool> decode(std::string &buffer, Message &message);

/// Sends all of it; false when the other side is gone. [blocks]
bool isSent(int fd, const Message &message);

/// Waits for one message; an error when the other side is gone. [blocks]
Result<Message> receive(int fd);

/// The socket and the lock of an instance.
Result<std::string> socket_path(const std::string &instance);
Result<std::string> lock_path(const std::string &instance);

/// Takes the lock of an instance, which goes with the descriptor that is given: nothing else may be done to
/// the instance meanwhile. -1 when another process holds it. Remove the file (drop_lock) before the end.
Result<int> take_lock(const std::string &instance);
/// Removes the lock file and gives the lock back.
void drop_lock(const std::string &instance, int fd);
/// True while a process holds the lock; makes no file.
bool isLockTaken(const std::string &instance);

}  // namespace mw::hal
