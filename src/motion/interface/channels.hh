// SPDX-License-Identifier: GPL-2.0-or-later
// The memory shared by the task process and the realtime process. Contains no pointers. In task, one thread
// pushes commands and pops answers and faults. In the realtime process, the servo thread and the planner use
// it.
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
    std::uint8_t isEnabled = 0;  ///< the amplifiers of all active joints are enabled
    std::uint8_t isInMotion = 0;
    /// Counts changes of the kinematics type (with overflow). After a change the same joint positions have a
    /// different pose.
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

    /// Counts the loops of the task process. If it does not change for the watchdog's time, task hangs.
    std::atomic<std::uint64_t> task_loops{0};
    /// Counts cycles of the ordinary thread of the realtime host. If this count stops too, the computer is
    /// too busy for both.
    std::atomic<std::uint32_t> host_looks{0};
    /// Set by the realtime host when the kernel reports that the task process has ended (pidfd, closed
    /// socket).
    std::atomic<std::uint32_t> isTaskDead{0};

    /// The servo thread fills the trace while `isTracing`. If the ring is full, the sample is counted in
    /// `trace_lost`.
    std::atomic<std::uint32_t> isTracing{0};
    std::atomic<std::uint64_t> trace_lost{0};
    SpscRing<TraceSample, 8192> trace;  ///< servo -> client that records a trace

    /// True if the servo thread must answer commands.
    bool hasCommands() const noexcept { return immediate.front() != nullptr; }
};

}  // namespace mw::motion
