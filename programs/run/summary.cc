// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/summary.hh"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "machine/config/machine_config.hh"

namespace mw::programs {
namespace {

std::string time_text(double seconds) {
    const int minutes = static_cast<int>(seconds / 60);
    return minutes > 0 ? fmt::format("{} min {:.3f} s", minutes, seconds - 60.0 * minutes)
                       : fmt::format("{:.3f} s", seconds);
}

void print_axes(const char *label, const Summary &summary, const std::array<double, MAX_AXES> &values,
                const char *power) {
    std::string text;
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((summary.machine.axis_mask & (1U << axis)) == 0) {
            continue;
        }
        const char *unit = geometry::isAngular(axis) ? "deg" : (summary.machine.metric ? "mm" : "in");
        text += fmt::format("  {} {:.4g} {}/{}", geometry::AXIS_LETTERS[axis],
                            values[static_cast<std::size_t>(axis)], unit, power);
    }
    fmt::print("{:<18}{}\n", label, text);
}

void print_lengths(const machine::RunFigures &path, const char *unit) {
    const auto turned = [](double angle_deg) {
        return angle_deg > 0 ? fmt::format(", {:.3f} deg", angle_deg) : std::string();
    };
    fmt::print("cutting             {:.3f} {}{}\n", path.cutting_length, unit,
               turned(path.cutting_angle_deg));
    fmt::print("rapid               {:.3f} {}{}\n", path.rapid_length, unit, turned(path.rapid_angle_deg));
}

void print_peaks(const Summary &summary, const machine::RunFigures &path) {
    print_axes("peak velocity", summary, path.peak_velocity, "s");
    print_axes("peak acceleration", summary, path.peak_acceleration, "s2");
    fmt::print("{}", summary.certificate);
}

}  // namespace

void print_summary(const Summary &summary) {
    const char *unit = summary.machine.metric ? "mm" : "in";
    fmt::print("program             {} on {}\n", summary.program, summary.machine.name);
    fmt::print("read beforehand     {}{} blocks\n", summary.check.whole ? "all " : "the first ",
               summary.check.blocks);
    fmt::print("cycle time          {}\n", time_text(summary.run.cycle_time_s));
    if (!summary.was_realtime) {
        fmt::print("simulated in        {:.3f} s, {:.0f} times faster than the clock\n",
                   summary.run.wall_time_s,
                   summary.run.cycle_time_s / std::fmax(summary.run.wall_time_s, 1e-9));
    }
    if (summary.path.has_value()) {
        print_lengths(*summary.path, unit);
    }
    fmt::print("blocks              {}\n", summary.run.blocks);
    if (summary.path.has_value()) {
        print_peaks(summary, *summary.path);
    }
    if (summary.run.stops_passed > 0) {
        fmt::print("program stops       {} passed\n", summary.run.stops_passed);
    }
    if (summary.was_realtime && summary.realtime.has_value()) {
        fmt::print("realtime            {}\n",
                   summary.realtime->realtime ? "yes" : "no: " + summary.realtime->missing);
        fmt::print("overruns            {}\n", summary.realtime->overruns);
        fmt::print("largest latency     {:.1f} us\n",
                   static_cast<double>(summary.realtime->max_latency_ns) * 1e-3);
    }
    fmt::print("warnings            {}\n", summary.run.warnings);
    std::fflush(stdout);
}

}  // namespace mw::programs
