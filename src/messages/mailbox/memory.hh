// SPDX-License-Identifier: GPL-2.0-or-later
// Memory of a mailbox: in this process, or in shared memory with the name of the machine's instance.
#pragma once

#include <memory>
#include <string>

#include "messages/mailbox/segment.hh"
#include "runtime/activity.hh"
#include "runtime/instance_lock.hh"
#include "runtime/shared_memory.hh"

namespace mw::mailbox {

/// Owns the mapping; both types of memory are used in the same manner.
class Memory {
  public:
    /// For task and clients in one process, as under the virtual clock.
    static Memory in_process();
    /// Called by task. An error when a running task of any user has this name. Replaces the memory of a dead
    /// task of this user; memory of a dead task of another user has no effect, because each user has separate
    /// names.
    static Result<Memory> create(const std::string &instance);
    /// Called by a client.
    static Result<Memory> attach(const std::string &instance);

    /// For an owner that ends without destruction: clients can no longer find the memory.
    void remove() noexcept { shared_.remove(); }

    Segment &segment() { return *segment_; }
    /// True while the process that created the memory is alive; always true within one process.
    bool isOwnerAlive() const;
    /// Id of the process that created shared memory; otherwise of this process.
    int owner_pid() const;
    /// Wakes all threads that sleep at the bell.
    static void ring(Segment &segment);
    /// Sleeps until the bell has another value than `heard`, or until the timeout. True if the value has
    /// changed.
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

/// This process as one word: its id and start time.
std::uint64_t owner_word();
bool isAlive(std::uint64_t owner);
runtime::Activity activity_of(std::uint64_t owner);
int pid_of(std::uint64_t owner);

}  // namespace mw::mailbox
