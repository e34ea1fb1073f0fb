// SPDX-License-Identifier: GPL-2.0-or-later
// What the two stream programs do alike: join the instance, end on signals, report.
#pragma once

#include <csignal>
#include <cstdio>
#include <functional>
#include <string>

#include "base/stop_signals.hh"
#include "base/text.hh"
#include "hal/core/hal.hh"

namespace mw::cli {

/// Runs `work` attached to the user's instance; the exit status.
inline int run_attached(const char *program,
                        const std::function<Result<>(volatile std::sig_atomic_t &)> &work) {
    catch_stop_signals();
    const auto instance = hal::Hal::attach(hal::default_instance());
    Result<> result;
    if (instance) {
        hal::set_process_instance(instance->get());
        result = work(stop_signal);
        hal::set_process_instance(nullptr);
    } else {
        result = std::unexpected(instance.error());
    }
    if (!result) {
        std::fprintf(stderr, "%s: %s\n", program, result.error().str().c_str());
    }
    return result ? 0 : 1;
}

/// The number behind an option; false (with a message) when it is none of at least 0.
inline bool parse_count(const char *program, const char *text, long &value) {
    const std::optional<std::int64_t> number = parse_int(text);
    if (!number || *number < 0) {
        std::fprintf(stderr, "%s: '%s' is not a number of at least 0\n", program, text);
        return false;
    }
    value = static_cast<long>(*number);
    return true;
}

}  // namespace mw::cli
