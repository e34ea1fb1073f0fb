// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/processes.hh"

#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "hal/core/detail/impl.hh"

namespace mw::hal {

std::int32_t pid_of(int fd) {
    const auto told = fd >= 0 ? read_file(fmt::format("/proc/self/fdinfo/{}", fd)) : Result<std::string>("");
    const std::size_t at = told.has_value() ? told->find("Pid:") : std::string::npos;
    return at != std::string::npos ? std::atoi(told->c_str() + at + std::strlen("Pid:")) : 0;
}

bool end_dead_components(Hal &hal, std::int32_t spared_pid) {
    const rtapi::ProcessId self = rtapi::this_process();
    auto &impl = hal.impl();
    bool isAny = false;
    detail::Guard guard(impl);
    impl.segment.each<detail::CompRecord>(detail::Kind::COMP, [&](detail::CompRecord &comp) {
        const bool isSpared = comp.process == self || comp.process.pid == spared_pid;
        if (!isSpared && !rtapi::isAlive(comp.process)) {
            impl.remove_comp(comp, true);
            isAny = true;
        }
    });
    return isAny;
}

}  // namespace mw::hal
