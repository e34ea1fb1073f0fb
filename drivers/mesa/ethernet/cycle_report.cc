// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/ethernet/cycle_report.hh"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace mw::mesa {

namespace {

/// Packets on a fast network need less. Source: shared/hardware.md, part A4.
constexpr std::int64_t SLOW_SEND_NS = 200'000;

TimeFigures figures_of_times(std::vector<std::int64_t> times) {
    if (times.empty()) {
        return {};
    }
    std::ranges::sort(times);
    const auto at = [&](double part) {
        return times[std::min(times.size() - 1,
                              static_cast<std::size_t>(part * static_cast<double>(times.size())))];
    };
    return {.median_ns = at(0.5), .p999_ns = at(0.999), .max_ns = times.back()};
}

void count_outcome(const CycleTimes &cycle, CycleFigures &figures) {
    switch (cycle.outcome) {
    case CycleOutcome::NO_ANSWER: ++figures.no_answer; break;
    case CycleOutcome::SEND_FAILED: ++figures.send_failed; break;
    case CycleOutcome::RECEIVE_FAILED: ++figures.receive_failed; break;
    case CycleOutcome::SHORT_ANSWER: ++figures.short_answer; break;
    case CycleOutcome::WRITE_LOST: ++figures.write_lost; break;
    case CycleOutcome::DONE:
    case CycleOutcome::OTHER_BOARD: break;
    }
    figures.late_answers += cycle.stale;
    figures.error = cycle.error != 0 ? cycle.error : figures.error;
}

bool hasCounters(const CycleTimes &cycle) {
    // A cycle without the counter was the comparison of the board after a fault.
    return cycle.board_packets != 0 &&
           (cycle.outcome == CycleOutcome::DONE || cycle.outcome == CycleOutcome::WRITE_LOST);
}

/// Packets that were sent between two answered cycles and that the board has not counted.
std::int64_t lost_between(const CycleTimes &before, const CycleTimes &after) {
    const auto sent = static_cast<std::uint16_t>(after.host_packets - before.host_packets);
    const auto received = static_cast<std::uint16_t>(after.board_packets - before.board_packets);
    return std::max(0, static_cast<int>(static_cast<std::int16_t>(sent - received)));
}

std::string us(std::int64_t ns) {
    return fmt::format("{} us", ns / 1000);
}

}  // namespace

CycleFigures figures_of(std::span<const CycleTimes> cycles, std::int64_t period_ns) {
    CycleFigures figures;
    figures.cycles = cycles.size();
    figures.period_ns = period_ns;
    std::vector<std::int64_t> late, send, answer, gap;
    const CycleTimes *before = nullptr, *counted = nullptr;
    for (const CycleTimes &cycle : cycles) {
        count_outcome(cycle, figures);
        if (before != nullptr) {
            late.push_back(std::max<std::int64_t>(0, cycle.begin_ns - before->begin_ns - period_ns));
            figures.late_cycles += late.back() > period_ns / 2 ? 1 : 0;
            if (cycle.written_ns != 0 && before->written_ns != 0) {
                gap.push_back(cycle.written_ns - before->written_ns);
            }
        }
        send.push_back(cycle.sent_ns - cycle.begin_ns);
        if (cycle.answered_ns != 0) {
            answer.push_back(cycle.answered_ns - cycle.sent_ns);
        }
        if (hasCounters(cycle)) {
            figures.lost_to_board += counted != nullptr ? lost_between(*counted, cycle) : 0;
            counted = &cycle;
        }
        before = &cycle;
    }
    figures.late = figures_of_times(std::move(late));
    figures.send = figures_of_times(std::move(send));
    figures.answer = figures_of_times(std::move(answer));
    figures.gap = figures_of_times(std::move(gap));
    return figures;
}

std::vector<CycleCause> causes_of(const CycleFigures &figures) {
    std::vector<CycleCause> causes;
    if (figures.send_failed > 0 || figures.receive_failed > 0) {
        causes.push_back(
            {fmt::format("The kernel did not send or receive {} packets: {}.",
                         figures.send_failed + figures.receive_failed, std::strerror(figures.error)),
             "Check the cable, the address of the network card and the firewall rules: ip "
             "address, nft list ruleset."});
    }
    if (figures.late_cycles > 0) {
        causes.push_back(
            {fmt::format("The thread began {} cycles more than half a period late, the worst by {}.",
                         figures.late_cycles, us(figures.late.max_ns)),
             "Measure with latency-test. Use the realtime kernel, isolate a processor "
             "(isolcpus=), and switch power saving off."});
    }
    if (figures.send.p999_ns > SLOW_SEND_NS || figures.send.max_ns > figures.period_ns / 2) {
        causes.push_back(
            {fmt::format("The kernel needed up to {} to accept a packet.", us(figures.send.max_ns)),
             "Use the network card only for the board, and give its interrupt a high priority."});
    }
    if (figures.late_answers > 0) {
        causes.push_back({fmt::format("{} answers came after the deadline.", figures.late_answers),
                          "The network card is slow or shared. Switch interrupt coalescing off (ethtool -C "
                          "CARD rx-usecs 0) "
                          "and use no switch between card and board; or raise packet-read-timeout."});
    }
    if (figures.lost_to_board > 0) {
        causes.push_back({fmt::format("{} packets did not reach the board.", figures.lost_to_board),
                          "Change the cable, and keep it away from cables of drives and spindle."});
    }
    const auto unexplained = static_cast<std::int64_t>(figures.no_answer + figures.short_answer) -
                             static_cast<std::int64_t>(figures.late_answers) - figures.lost_to_board;
    if (unexplained > 0) {
        causes.push_back(
            {fmt::format("{} replies of the board were lost, or the board was off.", unexplained),
             "Check the supply of the board, the cable and the connectors."});
    }
    return causes;
}

}  // namespace mw::mesa
