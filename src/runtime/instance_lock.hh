// SPDX-License-Identifier: GPL-2.0-or-later
// One machine of a name on this computer, whichever user has started it.
#pragma once

#include <string>
#include <utility>

#include "base/result.hh"

namespace mw::runtime {

/// A socket in the kernel's abstract names: it leaves no file, and ends with its process however that ends.
/// [not realtime]
class InstanceLock {
  public:
    InstanceLock() = default;
    ~InstanceLock();
    InstanceLock(InstanceLock &&other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    InstanceLock &operator=(InstanceLock &&other) noexcept {
        std::swap(fd_, other.fd_);
        return *this;
    }

    /// An error names the process that holds it, its user, and what to do.
    static Result<InstanceLock> take(const std::string &instance);

  private:
    int fd_ = -1;
};

}  // namespace mw::runtime
