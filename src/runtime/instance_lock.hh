// SPDX-License-Identifier: GPL-2.0-or-later
// Ensures that only one machine with a given name runs on this computer, for all users.
#pragma once

#include <string>
#include <utility>

#include "base/result.hh"

namespace mw::runtime {

/// A socket in the abstract namespace of the kernel: it leaves no file, and disappears when its process ends
/// for any reason. [not realtime]
class InstanceLock {
  public:
    InstanceLock() = default;
    ~InstanceLock();
    InstanceLock(InstanceLock &&other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    InstanceLock &operator=(InstanceLock &&other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }

    /// An error names the process that holds the lock, its user, and what to do.
    static Result<InstanceLock> take(const std::string &instance);

  private:
    int fd_ = -1;
};

}  // namespace mw::runtime
