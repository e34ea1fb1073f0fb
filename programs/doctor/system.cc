// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/system.hh"

#include <linux/capability.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "base/capabilities.hh"
#include "base/text.hh"
#include "runtime/process.hh"

namespace mw::doctor {
namespace {

/// The first line of a file; empty when it cannot be read.
std::string line_of(const std::string &path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    return std::string(trim(line));
}

void examine_kernel(const std::string &root, diagnostics::Sink &sink) {
    utsname kernel{};
    ::uname(&kernel);
    const bool realtime = line_of(root + "/sys/kernel/realtime") == "1";
    if (realtime) {
        sink.note(fmt::format("kernel {} has PREEMPT_RT", kernel.release));
    } else {
        sink.warning(fmt::format("kernel {} has no PREEMPT_RT: its latency is not bounded", kernel.release),
                     {}, "a real machine needs linux-image-rt-amd64; a simulated machine does not");
    }
    const std::string clock =
        line_of(root + "/sys/devices/system/clocksource/clocksource0/current_clocksource");
    if (clock == "hpet" || clock == "acpi_pm" || clock == "jiffies") {
        sink.warning("the clock of the kernel is " + clock + ", which is slow to read", {},
                     "clocksource=tsc on the kernel's command line, if the TSC of the processor is stable");
    }
}

void examine_processors(const std::string &root, diagnostics::Sink &sink) {
    const unsigned count = std::thread::hardware_concurrency();
    if (count == 1) {
        sink.warning("there is one processor: realtime threads share it with everything else");
    } else if (line_of(root + "/sys/devices/system/cpu/isolated").empty()) {
        sink.warning(
            "no processor is isolated: other programs share it with the realtime threads", {},
            fmt::format("isolcpus={0} nohz_full={0} rcu_nocbs={0} on the kernel's command line", count - 1));
    }
    std::set<std::string> governors;
    for (unsigned cpu = 0; cpu < count; ++cpu) {
        governors.insert(
            line_of(fmt::format("{}/sys/devices/system/cpu/cpu{}/cpufreq/scaling_governor", root, cpu)));
    }
    governors.erase("");
    governors.erase("performance");
    if (!governors.empty()) {
        sink.warning("the CPU frequency governor is '" + *governors.begin() + '\'', {},
                     "cpupower frequency-set -g performance, and C-states off in the BIOS");
    }
    std::ifstream info(root + "/proc/cpuinfo");
    for (std::string line; std::getline(info, line);) {
        if (line.starts_with("flags") && line.find(" hypervisor") != std::string::npos) {
            sink.warning("this is a virtual machine: its host decides when it runs");
            break;
        }
    }
}

/// Capabilities of a file. Layout: linux/capability.h, vfs_cap_data.
std::uint32_t capabilities_of(const std::string &path) {
    std::array<unsigned char, 32> raw{};
    const ssize_t size = ::getxattr(path.c_str(), "security.capability", raw.data(), raw.size());
    constexpr std::size_t PERMITTED = 4;
    if (size < static_cast<ssize_t>(PERMITTED + 4)) {
        return 0;
    }
    std::uint32_t permitted = 0;
    std::memcpy(&permitted, raw.data() + PERMITTED, sizeof permitted);
    return permitted;
}

bool isAllowed(int resource, rlim_t wanted) {
    rlimit limit{};
    return ::getrlimit(static_cast<__rlimit_resource>(resource), &limit) == 0 &&
           (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= wanted);
}

void examine_rights(const std::string &program, diagnostics::Sink &sink) {
    constexpr std::uint32_t IPC_LOCK = 1U << CAP_IPC_LOCK, SYS_NICE = 1U << CAP_SYS_NICE,
                            SYS_RESOURCE = 1U << CAP_SYS_RESOURCE;
    constexpr rlim_t PRIORITY = 85, MEMORY = rlim_t{512} << 20U;
    // Root in a container may lack some capabilities.
    const std::uint64_t has = ::geteuid() == 0 ? effective_capabilities() : capabilities_of(program);
    const std::string setcap = "sudo setcap cap_sys_nice,cap_ipc_lock,cap_sys_resource+p " + program;
    const std::string remedy = setcap + "; or rtprio and memlock in /etc/security/limits.d";
    if ((has & SYS_NICE) == 0 && !isAllowed(RLIMIT_RTPRIO, PRIORITY)) {
        sink.warning("millwright-rt may not raise its priority: the machine is not realtime", {}, remedy);
    }
    if ((has & IPC_LOCK) == 0 && !isAllowed(RLIMIT_MEMLOCK, MEMORY)) {
        sink.warning("millwright-rt may not lock its memory: the machine is not realtime", {}, remedy);
    }
    if ((has & SYS_RESOURCE) == 0) {
        sink.warning("the kernel may kill millwright-rt when memory runs out: it has no right to lower its "
                     "oom_score_adj",
                     {}, setcap);
    }
    if (::access("/dev/shm", W_OK) != 0) {
        sink.error("this user cannot create shared memory: /dev/shm is not writable");
    }
    if (const auto folder = runtime::runtime_folder(); !folder.has_value()) {
        sink.error(folder.error());
    }
}

}  // namespace

void examine_system(const std::string &root, const std::string &realtime_program, diagnostics::Sink &sink) {
    examine_kernel(root, sink);
    examine_processors(root, sink);
    examine_rights(realtime_program, sink);
}

}  // namespace mw::doctor
