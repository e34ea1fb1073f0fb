// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/doctor/boards.hh"

#include <chrono>
#include <string>

#include <fmt/format.h>

#include "drivers/mesa/ethernet/cycle_report.hh"

namespace mw::doctor {
namespace {

std::string text_of(mesa::BoardFault fault) {
    switch (fault) {
    case mesa::BoardFault::STOPPED: return "too many cycles failed: communication was stopped";
    case mesa::BoardFault::OTHER_BOARD: return "another board answers at this address";
    case mesa::BoardFault::WATCHDOG: return "its watchdog has tripped";
    case mesa::BoardFault::NONE: break;
    }
    return "no fault";
}

std::int64_t us(std::int64_t ns) {
    return ns / 1000;
}

void tell_causes(const std::string &board, const mesa::CycleFigures &figures, diagnostics::Sink &sink) {
    for (const mesa::CycleCause &one : mesa::causes_of(figures)) {
        sink.warning(fmt::format("{}: {}", board, one.cause), {}, one.remedy);
    }
}

}  // namespace

void judge_board(const mesa::RecordedCycles &cycles, std::int64_t now_ns, diagnostics::Sink &sink) {
    if (cycles.fault != mesa::BoardFault::NONE) {
        sink.warning(fmt::format("{} at {}: {}, {} s ago; the {} cycles before it are examined", cycles.board,
                                 cycles.address, text_of(cycles.fault),
                                 (now_ns - cycles.fault_ns) / 1'000'000'000, cycles.at_fault.size()));
        tell_causes(cycles.board, mesa::figures_of(cycles.at_fault, cycles.period_ns), sink);
    }
    const mesa::CycleFigures figures = mesa::figures_of(cycles.since, cycles.period_ns);
    if (figures.cycles == 0) {
        return;
    }
    sink.note(fmt::format("{} at {}: {} cycles of {} us, {} failed; answers after {} us, 99.9 percent within "
                          "{} us, the slowest {} us",
                          cycles.board, cycles.address, figures.cycles, us(figures.period_ns),
                          figures.failures(), us(figures.answer.median_ns), us(figures.answer.p999_ns),
                          us(figures.answer.max_ns)));
    tell_causes(cycles.board, figures, sink);
}

void examine_boards(diagnostics::Sink &sink) {
    const std::int64_t now_ns = std::chrono::steady_clock::now().time_since_epoch().count();
    for (const std::string &path : mesa::find_cycle_records()) {
        if (const auto cycles = mesa::read_cycle_record(path)) {
            judge_board(*cycles, now_ns, sink);
        } else {
            sink.warning(cycles.error().message);
        }
    }
}

}  // namespace mw::doctor
