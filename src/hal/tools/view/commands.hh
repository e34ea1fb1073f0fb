// SPDX-License-Identifier: GPL-2.0-or-later
// Programs that show HAL: `millwright hal ...`, latency-test, latency-histogram.
#pragma once

#include <csignal>
#include <string>
#include <vector>

namespace mw::hal::view {

/// `millwright hal [COMMAND ...]`; returns the exit status: 0 done, 1 rejected or failed, 2 wrong usage.
/// `stop` becomes nonzero on a stop signal.
int command_hal(const std::vector<std::string> &words, volatile std::sig_atomic_t &stop);

/// `latency-test [base-period [servo-period]]`; a period of 0 omits the base thread.
int latency_test(const std::vector<std::string> &words, volatile std::sig_atomic_t &stop);

/// `latency-histogram [--base ns] [--servo ns] ...`.
int latency_histogram(const std::vector<std::string> &words, volatile std::sig_atomic_t &stop);

}  // namespace mw::hal::view
