// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/beliefs.hh"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include <fmt/format.h>

namespace mw::task_campaign {
namespace {

Place place_of(const geometry::Pose &pose) {
    return {pose[0], pose[1], pose[2]};
}

bool isSame(const Place &a, const Place &b) {
    return task_campaign::isSame(a[0], b[0]) && task_campaign::isSame(a[1], b[1]) &&
           task_campaign::isSame(a[2], b[2]);
}

std::string str(const Place &p) {
    return fmt::format("{:.4f} {:.4f} {:.4f}", p[0], p[1], p[2]);
}

bool hasCode(const messages::CodesStatus &codes, int tenfold) {
    return std::find(codes.g.begin() + 1, codes.g.end(), tenfold) != codes.g.end();
}

std::vector<Tool> tools_of(const messages::ToolTable &table, bool isRandom) {
    std::vector<Tool> tools;
    for (std::size_t i = 0; i < table.tools.size(); ++i) {
        const messages::ToolRecord &record = table.tools[i];
        if (record.toolno > 0 && (i > 0 || isRandom)) {
            tools.push_back({record.toolno, record.pocketno, record.offset[2]});
        }
    }
    return tools;
}

/// "T3 P4 Z1.5 D0 ;words"
std::vector<Tool> tools_of(const std::string &text) {
    std::vector<Tool> tools;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        Tool tool;
        std::istringstream words(line.substr(0, line.find(';')));
        for (std::string word; words >> word;) {
            const double value = std::strtod(word.c_str() + 1, nullptr);
            tool.number = word[0] == 'T' ? static_cast<int>(value) : tool.number;
            tool.pocket = word[0] == 'P' ? static_cast<int>(value) : tool.pocket;
            tool.z = word[0] == 'Z' ? value : tool.z;
        }
        if (tool.number > 0) {
            tools.push_back(tool);
        }
    }
    return tools;
}

/// State that is equal in all possible states.
std::string state_trouble(const messages::MachineStatus &status, messages::Mode mode,
                          const Beliefs &beliefs) {
    const messages::TaskStatus &task = status.task;
    const messages::OverridesStatus &overrides = status.overrides;
    const bool isOff = beliefs.state == messages::State::OFF && task.state == messages::State::ESTOP_RESET;
    if (task.state != beliefs.state && !isOff) {
        return fmt::format("the state is {}, not {}", static_cast<int>(task.state),
                           static_cast<int>(beliefs.state));
    }
    if (task.mode != mode) {
        return fmt::format("the mode is {}, not {}", static_cast<int>(task.mode), static_cast<int>(mode));
    }
    if (task.isPaused || task.queued_mdi != 0 || task.interp_state != messages::InterpState::IDLE ||
        status.approach.number != 0 || status.trajectory.queue_depth != 0) {
        return "a program is paused, waits or is proposed";
    }
    if (task.isOptionalStop != beliefs.isOptionalStop || task.isBlockDelete != beliefs.isBlockDelete) {
        return "optional stop or block delete is not as it was set";
    }
    if (status.trajectory.isAllHomed != beliefs.isHomed) {
        return fmt::format("homed is {}", status.trajectory.isAllHomed);
    }
    return task_campaign::isSame(overrides.feed, beliefs.feed_override)
               ? ""
               : fmt::format("the feed override is {}, not {}", overrides.feed, beliefs.feed_override);
}

/// State of pins, which no message changes.
std::string output_trouble(const Bench &bench, messages::State state) {
    const Bench::Pins &pins = bench.pins();
    const messages::MachineStatus &status = bench.status();
    if (*pins.is_amp_on != (state == messages::State::ON)) {
        return "the amplifiers are not as the state is";
    }
    if (*pins.tool_prepare || *pins.tool_change) {
        return "something is asked of the changer";
    }
    const messages::SpindleStatus &spindle = status.spindles[0];
    if (*pins.spindle_on != spindle.isOn || *pins.mist != status.io.coolant.isMistOn ||
        *pins.flood != status.io.coolant.isFloodOn || *pins.tool_number != status.tool.in_spindle) {
        return "pins and status differ";
    }
    return state != messages::State::ON && *pins.spindle_on ? "a spindle turns on a machine that is off" : "";
}

Modes seen_in_file(const Bench &bench) {
    const auto all = bench.parameters();
    const auto value = [&](int number) {
        const auto found = all.find(number);
        return found != all.end() ? found->second : 0.0;
    };
    const auto place = [&](int first) -> Place { return {value(first), value(first + 1), value(first + 2)}; };
    Modes seen;
    seen.system = static_cast<int>(value(5220));
    for (int i = 0; i < SYSTEMS; ++i) {
        seen.systems[static_cast<std::size_t>(i)] = place(5221 + 20 * i);
    }
    seen.isG92On = value(5210) != 0;
    seen.kept_g92 = place(5211);
    seen.g28 = place(5161);
    seen.g30 = place(5181);
    seen.kept = value(3101);
    return seen;
}

/// `why`: the first mismatch.
bool fits(const World &world, const Bench &bench, bool isHomed, std::string &why) {
    const messages::MachineStatus &status = bench.status();
    const Bench::Pins &pins = bench.pins();
    const Modes &m = world.modes;
    const Doings &d = world.doings;
    const messages::OffsetsStatus &offsets = status.offsets;
    const messages::CodesStatus &codes = status.codes;
    const Place system = m.systems[static_cast<std::size_t>(m.system - 1)];
    const Place at = place_of(status.trajectory.position_cmd);
    const auto differs = [&](bool isOther, const std::string &text) {
        why = isOther && why.empty() ? text : why;
        return isOther;
    };
    why.clear();
    const double rpm = d.direction * d.turning_rpm;
    constexpr double MM_PER_INCH = 25.4;
    const double feed = m.isInch ? m.feed_mm_min / MM_PER_INCH : m.feed_mm_min;
    if (differs(offsets.g5x_index != m.system, fmt::format("G5x {}, not {}", offsets.g5x_index, m.system)) ||
        differs(!isSame(place_of(offsets.g5x), system),
                fmt::format("G5x offset {}, not {}", str(place_of(offsets.g5x)), str(system))) ||
        differs(!isSame(place_of(offsets.g92), m.g92),
                fmt::format("G92 offset {}, not {}", str(place_of(offsets.g92)), str(m.g92))) ||
        differs(!task_campaign::isSame(offsets.tool[2], m.tool_z),
                fmt::format("tool offset {:.4f}, not {:.4f}", offsets.tool[2], m.tool_z)) ||
        differs(!task_campaign::isSame(codes.settings[1], feed),
                fmt::format("F {}, not {}", codes.settings[1], feed)) ||
        differs(!task_campaign::isSame(codes.settings[2], m.speed_rpm),
                fmt::format("S {}, not {}", codes.settings[2], m.speed_rpm)) ||
        differs(!hasCode(codes, m.isInch ? 200 : 210), "units") ||
        differs(!hasCode(codes, m.isAbsolute ? 900 : 910), "G90 or G91") ||
        differs(status.tool.in_spindle != d.in_spindle,
                fmt::format("tool {} in the spindle, not {}", status.tool.in_spindle, d.in_spindle)) ||
        differs(status.spindles[0].direction != d.direction,
                fmt::format("the spindle turns {}, not {}", status.spindles[0].direction, d.direction)) ||
        differs(!task_campaign::isSame(*pins.speed_out, rpm),
                fmt::format("spindle speed {}, not {}", *pins.speed_out, rpm)) ||
        differs(*pins.mist != d.isMist || *pins.flood != d.isFlood, "coolant") ||
        differs(isHomed && !isSame(at, d.at),
                fmt::format("the axes are at {}, not {}", str(at), str(d.at)))) {
        return false;
    }
    why = difference(m, seen_in_file(bench));
    why = why.empty() ? "" : "parameter file: " + why;
    if (why.empty()) {
        why = difference(d.tools, tools_of(bench.tool_table()));
        why = why.empty() ? "" : "tool table file: " + why;
    }
    return why.empty();
}

std::string client_trouble(Bench &bench, int number, const Beliefs &beliefs) {
    client::Client &client = bench.client(number);
    const auto read = client.read_status();
    const auto table = client.read_tools();
    if (!read.has_value() || !table.has_value()) {
        return "status or tools cannot be read";
    }
    if (client.status().cycle != bench.status().cycle) {
        return "another cycle is seen";
    }
    const Doings &d = beliefs.worlds[0].doings;
    return table->has_value() ? difference(d.tools, tools_of(**table, d.isRandom)) : "";
}

}  // namespace

void switch_devices_off(World &world) {
    world.doings.direction = 0;
    world.doings.turning_rpm = 0;
    world.doings.isMist = world.doings.isFlood = false;
}

void Beliefs::switch_devices_off() {
    std::ranges::for_each(worlds, [](World &world) { task_campaign::switch_devices_off(world); });
}

void add(std::vector<World> &worlds, const World &world) {
    if (std::ranges::find(worlds, world) == worlds.end()) {
        worlds.push_back(world);
    }
}

void adopt_place(const Bench &bench, Beliefs &beliefs) {
    for (World &world : beliefs.worlds) {
        world.doings.at = place_of(bench.status().trajectory.position_cmd);
    }
}

std::string judge(Bench &bench, messages::Mode mode, Beliefs &beliefs) {
    std::string trouble = state_trouble(bench.status(), mode, beliefs);
    trouble = trouble.empty() ? output_trouble(bench, beliefs.state) : trouble;
    if (!trouble.empty()) {
        return "status: " + trouble;
    }
    std::vector<World> left;
    std::string why, reasons;
    for (const World &world : beliefs.worlds) {
        if (fits(world, bench, beliefs.isHomed, why)) {
            left.push_back(world);
        } else if (reasons.find(why) == std::string::npos) {
            reasons += (reasons.empty() ? "" : ", or ") + why;
        }
    }
    if (left.empty()) {
        return fmt::format("world: none of {} possible ones: {}", beliefs.worlds.size(), reasons);
    }
    beliefs.worlds = std::move(left);
    for (int i = 0; i < CLIENTS; ++i) {
        trouble = trouble.empty() ? client_trouble(bench, i, beliefs) : trouble;
    }
    return trouble.empty() ? "" : "client: " + trouble;
}

}  // namespace mw::task_campaign
