// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/host/processes.hh"

#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "base/atomic_file.hh"

namespace mw::hal {

std::int32_t pid_of(int fd) {
    const auto told = fd >= 0 ? read_file(fmt::format("/proc/self/fdinfo/{}", fd)) : Result<std::string>("");
    const std::size_t at = told.has_value() ? told->find("Pid:") : std::string::npos;
    return at != std::string::npos ? std::atoi(told->c_str() + at + std::strlen("Pid:")) : 0;
}

}  // namespace mw::hal
