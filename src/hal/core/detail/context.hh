// SPDX-License-Identifier: GPL-2.0-or-later
// State of a thread for the C API and for crash reports.
#pragma once

#include <vector>

#include "hal/core/detail/segment.hh"
#include "hal/include/rtapi.h"

namespace mw::hal {

class Instance;

namespace detail {

struct ThreadRunner;

/// Uses no heap, so that a realtime thread can access it at once.
struct ThreadContext {
    Instance *instance = nullptr;          ///< overrides the process's instance
    bool realtime = false;                 ///< inside a HAL thread
    const char *loading = nullptr;         ///< name of the module being loaded
    const char *unloading = nullptr;       ///< name of the module being unloaded
    const char *doing = nullptr;           ///< other activity, for a crash report
    const ThreadRunner *thread = nullptr;  ///< current HAL thread
    const ListEntry *calling = nullptr;    ///< its current function
    std::vector<const rtapi_mp_info *> *parameters =
        nullptr;  ///< collects the parameters of the module being loaded
};
/// The context of the calling thread. [any thread, realtime-safe]
ThreadContext &context() noexcept;

}  // namespace detail
}  // namespace mw::hal
