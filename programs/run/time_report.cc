// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/time_report.hh"

#include <fmt/format.h>

namespace mw::programs {
namespace {

std::string time_text(double seconds) {
    const int minutes = static_cast<int>(seconds / 60);
    return minutes > 0 ? fmt::format("{} min {:.1f} s", minutes, seconds - 60.0 * minutes)
                       : fmt::format("{:.3f} s", seconds);
}

}  // namespace

void print_times(const gcode::TimeFigures &time) {
    fmt::print("  time {}: cutting {}, rapid {}, dwell {}\n", time_text(time.total_s),
               time_text(time.cutting_s), time_text(time.rapid_s), time_text(time.dwell_s));
    if (!time.isComplete) {
        fmt::print("  the time lacks moves that the planner could not drive: please report this program\n");
    }
    for (const auto &[tool, seconds] : time.by_tool) {
        fmt::print("  tool {}: {}\n", tool, time_text(seconds));
    }
    for (const auto &[section, seconds] : time.by_section) {
        if (time.by_section.size() > 1 && seconds > 0) {
            fmt::print("  section {}: {}\n", section.empty() ? "(none)" : section, time_text(seconds));
        }
    }
    for (const gcode::SlowPlace &place : time.slowest) {
        fmt::print("  {}:{}: {} more than at its feed, bound by {}\n", place.file, place.line,
                   time_text(place.lost_s), place.limit);
    }
}

}  // namespace mw::programs
