// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/latency.hh"

#include <unistd.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "hal/host/host_client.hh"

namespace mw::doctor {
namespace {

/// Tolerable latency as a fraction of the period: above it, positions are noticeably old and steps uneven.
constexpr double TOLERABLE = 0.25;

std::string microseconds(std::int64_t ns) {
    return fmt::format("{:.1f} us", static_cast<double>(ns) * 1e-3);
}

void sleep_s(double seconds, volatile std::sig_atomic_t &stop) {
    constexpr double SLICE_S = 0.05;
    for (double waited = 0; waited < seconds && stop == 0; waited += SLICE_S) {
        ::usleep(static_cast<useconds_t>(SLICE_S * 1e6));
    }
}

Result<std::vector<hal::view::LatencyFigures>> measure(const std::vector<hal::view::LatencyThread> &threads,
                                                       double seconds, volatile std::sig_atomic_t &stop,
                                                       std::string &missing) {
    auto host = hal::HostClient::start(fmt::format("doctor-{}", ::getpid()));
    if (!host.has_value()) {
        return std::unexpected(host.error());
    }
    Result<> done = (*host)->control();
    done = done ? hal::view::start_latency(**host, threads) : done;
    if (!done) {
        return std::unexpected(done.error());
    }
    missing = (*host)->hal().host_status().realtime_missing();
    sleep_s(seconds, stop);
    auto figures = hal::view::read_latency((*host)->hal(), threads);
    const Result<> ended = (*host)->shut_down();
    return ended ? figures : std::unexpected(ended.error());
}

}  // namespace

void judge_latency(const hal::view::LatencyFigures &figures, diagnostics::Sink &sink) {
    const std::int64_t jitter_ns = figures.jitter_ns();
    const std::string what =
        fmt::format("thread {} of {}: {} intervals, maximum deviation {}", figures.name,
                    microseconds(figures.period_ns), figures.intervals, microseconds(jitter_ns));
    if (figures.intervals == 0) {
        sink.warning(what + ": it has not run");
        return;
    }
    const double part = static_cast<double>(jitter_ns) / static_cast<double>(figures.period_ns);
    if (part <= TOLERABLE) {
        sink.note(what);
        return;
    }
    const std::string way = part >= 1 ? "it misses its period" : "step timing and positions are irregular";
    constexpr double STEP_NS = 1e5, LONGEST_NS = 5e6;
    const double longer_ns =
        std::max(1.0, std::ceil(static_cast<double>(jitter_ns) / TOLERABLE / STEP_NS)) * STEP_NS;
    const std::string otherwise =
        longer_ns <= LONGEST_NS ? fmt::format("; or use a period of {:.0f} ns", longer_ns) : "";
    sink.warning(what + ": " + way, {}, "first follow the warnings about kernel and processors" + otherwise);
}

void examine_latency(std::int64_t servo_period_ns, std::int64_t base_period_ns, double seconds,
                     volatile std::sig_atomic_t &stop, diagnostics::Sink &sink) {
    std::vector<hal::view::LatencyThread> threads;
    if (base_period_ns > 0 && base_period_ns < servo_period_ns) {
        threads.push_back({"base", base_period_ns, 100});
    }
    threads.push_back({"servo", servo_period_ns, 1000});
    std::string missing;
    const auto figures = measure(threads, seconds, stop, missing);
    if (!figures.has_value()) {
        sink.warning("latency cannot be measured: " + figures.error().str());
        return;
    }
    if (!missing.empty()) {
        sink.warning("latency is measured without realtime: " + missing);
    }
    for (const hal::view::LatencyFigures &one : *figures) {
        judge_latency(one, sink);
    }
}

}  // namespace mw::doctor
