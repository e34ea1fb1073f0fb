// SPDX-License-Identifier: GPL-2.0-or-later
// Memory of a mailbox: in this process, or in shared memory that is named after the machine's instance.
#pragma once

#include <memory>
#include <string>

#include "messages/mailbox/segment.hh"
#include "runtime/activity.hh"
#include "runtime/instance_lock.hh"
#include "runtime/shared_memory.hh"

namespace mw::mailbox {

/// Owns the mapping; both types are used alike.
class Memory {
  public:
    /// For task and clients in one process, as under the virtual clock.
    static Memory in_process();
    /// By task: an error when a running task of any user has one of this name. One of a dead task is
    /// replaced; that of another user does not matter, because each user has separate names.
    static Result<Memory> create(const std::string &instance);
    /// By a client.
    static Result<Memory> attach(const std::string &instance);

    /// For an owner that ends without being destroyed: no client finds it any more.
    void remove() noexcept { shared_.remove(); }

    Segment &segment() { return *segment_; }
    /// The process that made it lives. Always true in one process.
    bool isOwnerAlive() const;
    /// That process, of a shared one; this one otherwise.
    int owner_pid() const;
    /// Wakes all that sleep at the bell.
    static void ring(Segment &segment);
    /// Sleeps until the bell has another value than `heard`, or the time is over. True: it has.
    static bool wait(Segment &segment, std::uint32_t heard, std::int64_t timeout_ns);

  private:
    struct Unmap {
        void operator()(Segment *segment) const noexcept;
    };
    Memory() = default;
    std::unique_ptr<Segment, Unmap> own_;
    runtime::InstanceLock lock_;
    runtime::SharedMemory shared_;
    Segment *segment_ = nullptr;
};

/// This process as one word.
std::uint64_t owner_word();
bool isAlive(std::uint64_t owner);
runtime::Activity activity_of(std::uint64_t owner);
int pid_of(std::uint64_t owner);

}  // namespace mw::mailbox
