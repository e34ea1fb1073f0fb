// SPDX-License-Identifier: GPL-2.0-or-later
// Adapts the C++ classes to the C API: failures become a line in the log and a negated errno.
#pragma once

#include <cerrno>
#include <string>
#include <type_traits>

#include <fmt/core.h>

#include "hal/core/instance.hh"
#include "hal/include/hal.h"

namespace mw::hal::capi {

/// Logs an error of the instance; returns the negated errno that it set.
int complain(const Error &error) noexcept;

/// Logs the message; returns the negated code.
int complain(int code, const std::string &message) noexcept;

/// 0, or the result of complain().
int status_of(const Result<> &result) noexcept;

/// The log of the current instance, or of the process.
runtime::Log &current_log() noexcept;

/// Runs `work` on the current instance; -EINVAL when there is none. A Result<> becomes 0 or the result of
/// complain().
template <class Work>
int with_hal(Work work) {
    Instance *hal = current();
    if (hal == nullptr) {
        return complain(EINVAL, "this process is not connected to a HAL instance: call hal_init first");
    }
    if constexpr (std::is_same_v<decltype(work(*hal)), Result<>>) {
        return status_of(work(*hal));
    } else {
        return work(*hal);
    }
}

}  // namespace mw::hal::capi
