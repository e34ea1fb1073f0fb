// SPDX-License-Identifier: GPL-2.0-or-later
// Latency compared with the periods of a machine.
#pragma once

#include <csignal>

#include "base/diagnostics/sink.hh"
#include "hal/tools/view/latency.hh"

namespace mw::doctor {

/// Measures with a separate realtime process and judges the result. `stop` ends it early.
void examine_latency(std::int64_t servo_period_ns, std::int64_t base_period_ns, double seconds,
                     volatile std::sig_atomic_t &stop, diagnostics::Sink &sink);

/// Judges the figures for a machine: one finding for each thread.
void judge_latency(const hal::view::LatencyFigures &figures, diagnostics::Sink &sink);

}  // namespace mw::doctor
