// SPDX-License-Identifier: GPL-2.0-or-later
// The shared memory between the task process and the realtime process. Holds no pointers.
// Task side: one thread pushes commands and pops answers and faults. Realtime side: the servo thread and the
// planner.
#pragma once

#include <atomic>
#include <cstdint>

#include "base/spsc_ring.hh"
#include "motion/interface/command.hh"
#include "motion/interface/path_command.hh"
#include "motion/interface/status.hh"

namespace mw::motion {

/// One row of the trace: the commanded positions of one servo cycle (carte_pos_cmd and pos_cmd).
struct TraceSample {
    std::int64_t time_ns = 0;
    std::uint64_t cycle = 0;
    CommandId path_id = 0;  ///< the path command being executed, 0: none
    std::int32_t line = 0;
    std::uint8_t isEnabled = 0;  ///< amp enables of all active joints on
    std::uint8_t isInMotion = 0;
    /// Counts changes of the kinematics type, with overflow: the same joints have another pose after it.
    std::uint8_t pose_kind = 0;
    std::uint8_t isRetracing = 0;  ///< on the recorded path (reverse run)
    Epoch epoch = 0;
    geometry::Pose carte_pos_cmd;
    geometry::Pose programmed_pos_cmd;  ///< carte_pos_cmd without external offsets
    std::array<double, MAX_JOINTS> joint_pos_cmd{};
};

struct Channels {
    static constexpr std::uint32_t MAGIC = 0x4d574d43;  // "MWMC"
    static constexpr int SHMEM_KEY = 0x4d57;            ///< for rtapi_shmem_new
    std::uint32_t magic = 0;
    std::uint32_t layout_bytes = 0;  ///< sizeof(Channels) of the creator

    SpscRing<Command, 1024> immediate;       ///< task -> servo
    SpscRing<PathCommand, 4096> path;        ///< task -> planner
    SpscRing<Answer, 4096> servo_answers;    ///< servo -> task
    SpscRing<Answer, 8192> planner_answers;  ///< planner -> task
    SpscRing<Fault, 256> servo_faults;       ///< servo -> task
    SpscRing<Fault, 256> planner_faults;     ///< planner -> task
    PublishedStatus status;                  ///< servo -> any

    /// Counts the loops of the task process; no change in the watchdog's time means that it hangs.
    std::atomic<std::uint64_t> task_loops{0};
    /// Counts cycles of the ordinary thread of the realtime host. If this count stops too, the computer is
    /// too busy for both.
    std::atomic<std::uint32_t> host_looks{0};
    /// Set by the realtime host when the kernel reports the end of the task process (pidfd, closed socket).
    std::atomic<std::uint32_t> isTaskDead{0};

    /// Filled by the servo thread while `isTracing`; a full ring counts in `trace_lost`.
    std::atomic<std::uint32_t> isTracing{0};
    std::atomic<std::uint64_t> trace_lost{0};
    SpscRing<TraceSample, 8192> trace;  ///< servo -> client that records a trace

    /// The servo thread has commands to answer.
    bool hasCommands() const noexcept { return immediate.front() != nullptr; }
};

}  // namespace mw::motion
