// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/facts.hh"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace mw::task_campaign {
namespace {

constexpr const char *LETTERS = "XYZ";
constexpr double FEED_MM_MIN = 9000;

/// The parameter file has six digits after the point.
double rounded(double value) {
    constexpr double DIGITS = 1e6;
    return std::round(value * DIGITS) / DIGITS;
}

double unit(const Modes &m) {
    return m.isInch ? MM_PER_INCH : 1;
}

/// The axis positions at which program coordinates are zero.
double origin(const Modes &m, std::size_t axis) {
    return m.systems[static_cast<std::size_t>(m.system - 1)][axis] + m.g92[axis] + (axis == 2 ? m.tool_z : 0);
}

bool move(const Line &line, World &w) {
    Place to = w.doings.at;
    for (std::size_t i = 0; i < AXES; ++i) {
        if (line.values[i]) {
            const double by = *line.values[i] * unit(w.modes);
            to[i] = w.modes.isAbsolute ? by + origin(w.modes, i) : to[i] + by;
        }
    }
    w.doings.at = to;  // while the interpreter reads; the axes do not move to it
    return std::ranges::all_of(to, [](double x) { return std::abs(x) <= LIMIT_MM; });
}

void set_system(const Line &line, World &w) {
    Place &system = w.modes.systems[static_cast<std::size_t>(line.number - 1)];
    for (std::size_t i = 0; i < AXES; ++i) {
        system[i] = line.values[i] ? *line.values[i] * unit(w.modes) : system[i];
    }
}

void touch_off(const Line &line, World &w) {
    Modes &m = w.modes;
    Place &system = m.systems[static_cast<std::size_t>(line.number - 1)];
    for (std::size_t i = 0; i < AXES; ++i) {
        const double rest = w.doings.at[i] - m.g92[i] - (i == 2 ? m.tool_z : 0);
        system[i] = line.values[i] ? rest - *line.values[i] * unit(m) : system[i];
    }
}

void set_g92(const Line &line, World &w) {
    Modes &m = w.modes;
    for (std::size_t i = 0; i < AXES; ++i) {
        const double without = origin(m, i) - m.g92[i];
        m.g92[i] = line.values[i] ? w.doings.at[i] - without - *line.values[i] * unit(m) : m.g92[i];
    }
    m.kept_g92 = m.g92;
    m.isG92On = true;
}

bool set_tool(const Line &line, World &w) {
    for (Tool &tool : w.doings.tools) {
        tool.z = tool.number == line.number ? *line.values[2] * unit(w.modes) : tool.z;
    }
    return w.doings.has(line.number);
}

bool apply_offset(const Line &line, World &w) {
    Modes &m = w.modes;
    Doings &d = w.doings;
    switch (line.kind) {
    case Kind::SYSTEM: m.system = line.number; return true;
    case Kind::SET_SYSTEM: set_system(line, w); return true;
    case Kind::TOUCH_OFF: touch_off(line, w); return true;
    case Kind::G92: set_g92(line, w); return true;
    case Kind::FORGET_G92:
        m.g92 = m.kept_g92 = {};
        m.isG92On = false;
        return true;
    case Kind::SUSPEND_G92:
        m.g92 = {};
        m.isG92On = false;
        return true;
    case Kind::RESTORE_G92:
        m.g92 = m.kept_g92;
        m.isG92On = true;
        return true;
    case Kind::KEEP_G28: m.g28 = d.at; return true;
    case Kind::KEEP_G30: m.g30 = d.at; return true;
    case Kind::OFFSET:
        m.tool_z = d.z_of(line.number == 0 ? d.in_spindle : line.number);
        return line.number == 0 || d.has(line.number);
    case Kind::NO_OFFSET: m.tool_z = 0; return true;
    default: return true;
    }
}

bool apply_device(const Line &line, World &w) {
    Doings &d = w.doings;
    const bool isTool = (line.number == 0 && !d.isRandom) || d.has(line.number);
    switch (line.kind) {
    case Kind::SET_TOOL: return set_tool(line, w);
    case Kind::SELECT: return isTool;
    case Kind::CHANGE:
        // The spindle stops, whether the tool is already in it or not.
        if (isTool) {
            d.direction = 0;
            d.turning_rpm = 0;
        }
        // An empty spindle is emptied again, because it may contain a tool.
        if (isTool && (d.in_spindle != line.number || line.number == 0)) {
            d.load(line.number);
        }
        return isTool;
    case Kind::CALL_IT:
        if (isTool) {
            d.load(line.number);
        }
        return isTool;
    case Kind::TURN:
        w.modes.speed_rpm = std::abs(line.number);
        d.direction = line.number > 0 ? 1 : -1;
        d.turning_rpm = std::abs(line.number);
        return true;
    case Kind::HALT_SPINDLE:
        d.direction = 0;
        d.turning_rpm = 0;
        return true;
    case Kind::MIST: d.isMist = true; return true;
    case Kind::FLOOD: d.isFlood = true; return true;
    case Kind::DRY: d.isMist = d.isFlood = false; return true;
    default: return true;
    }
}

std::string axis_words(const Line &line) {
    std::string out;
    for (std::size_t i = 0; i < AXES; ++i) {
        out += line.values[i] ? fmt::format(" {}{:.4f}", LETTERS[i], *line.values[i]) : "";
    }
    return out;
}

std::string plain_text(const Line &line) {
    const int n = line.number;
    switch (line.kind) {
    case Kind::RAPID: return "G0" + axis_words(line);
    case Kind::FEED: return fmt::format("G1{} F{}", axis_words(line), n);
    case Kind::ABSOLUTE: return "G90";
    case Kind::INCREMENTAL: return "G91";
    case Kind::INCH: return "G20";
    case Kind::MM: return "G21";
    case Kind::SYSTEM: return fmt::format("G{}", 53 + n);
    case Kind::SET_SYSTEM: return fmt::format("G10 L2 P{}{}", n, axis_words(line));
    case Kind::TOUCH_OFF: return fmt::format("G10 L20 P{}{}", n, axis_words(line));
    case Kind::G92: return "G92" + axis_words(line);
    case Kind::FORGET_G92: return "G92.1";
    case Kind::SUSPEND_G92: return "G92.2";
    case Kind::RESTORE_G92: return "G92.3";
    case Kind::KEEP_G28: return "G28.1";
    case Kind::KEEP_G30: return "G30.1";
    case Kind::OFFSET: return n == 0 ? "G43" : fmt::format("G43 H{}", n);
    case Kind::NO_OFFSET: return "G49";
    case Kind::SET_TOOL: return fmt::format("G10 L1 P{}{}", n, axis_words(line));
    case Kind::CHANGE: return fmt::format("T{} M6", n);
    case Kind::SELECT: return fmt::format("T{}", n);
    case Kind::CALL_IT: return fmt::format("M61 Q{}", n);
    case Kind::TURN: return fmt::format("S{} M{}", std::abs(n), n > 0 ? 3 : 4);
    case Kind::HALT_SPINDLE: return "M5";
    case Kind::MIST: return "M7";
    case Kind::FLOOD: return "M8";
    case Kind::DRY: return "M9";
    case Kind::KEEP: return fmt::format("#3101 = {:.4f}", *line.values[0]);
    case Kind::DWELL: return fmt::format("G4 P{:.2f}", *line.values[0]);
    case Kind::STOP: return "M0";
    case Kind::OPTIONAL_STOP: return "M1";
    case Kind::REMARK: return "(a remark)";
    case Kind::WRONG: return line.wrong;
    }
    return "";
}

Place some_values(plants::Random &random, const Modes &m) {
    Place out{};
    for (double &value : out) {
        value = random.whole(-16, 16) * (m.isInch ? 0.02 : 0.5);
    }
    return out;
}

void give_axes(plants::Random &random, const World &world, Line &line) {
    const Place values = some_values(random, world.modes);
    for (std::size_t i = 0; i < AXES; ++i) {
        if (random.chance(0.6)) {
            line.values[i] = values[i];
        }
    }
    const std::size_t sure = static_cast<std::size_t>(random.whole(0, AXES - 1));
    line.values[sure] = values[sure];
}

int some_tool(plants::Random &random, const Doings &doings) {
    const auto &tools = doings.tools;
    return tools[static_cast<std::size_t>(random.whole(0, static_cast<int>(tools.size()) - 1))].number;
}

Line make_offset_line(plants::Random &random, const World &world) {
    static constexpr Kind KINDS[] = {Kind::SYSTEM,     Kind::SET_SYSTEM,  Kind::TOUCH_OFF,   Kind::G92,
                                     Kind::FORGET_G92, Kind::SUSPEND_G92, Kind::RESTORE_G92, Kind::KEEP_G28,
                                     Kind::KEEP_G30,   Kind::OFFSET,      Kind::NO_OFFSET,   Kind::KEEP};
    Line line;
    line.kind = KINDS[random.whole(0, static_cast<int>(std::size(KINDS)) - 1)];
    line.number = random.whole(1, SYSTEMS);
    if (line.kind == Kind::OFFSET) {
        line.number = random.chance(0.5) ? 0 : some_tool(random, world.doings);
    }
    if (line.kind == Kind::KEEP) {
        line.values[0] = random.whole(-400, 400) * 0.25;
    } else if (line.kind == Kind::SET_SYSTEM || line.kind == Kind::TOUCH_OFF || line.kind == Kind::G92) {
        give_axes(random, world, line);
    }
    return line;
}

Line make_device_line(plants::Random &random, const World &world) {
    static constexpr Kind KINDS[] = {Kind::SET_TOOL, Kind::CHANGE, Kind::CHANGE, Kind::SELECT,
                                     Kind::CALL_IT,  Kind::TURN,   Kind::TURN,   Kind::HALT_SPINDLE,
                                     Kind::MIST,     Kind::FLOOD,  Kind::DRY};
    Line line;
    line.kind = KINDS[random.whole(0, static_cast<int>(std::size(KINDS)) - 1)];
    if (line.kind == Kind::TURN) {
        line.number = random.whole(2, 30) * 100 * (random.chance(0.7) ? 1 : -1);
        return line;
    }
    const bool isNone = !world.doings.isRandom && line.kind != Kind::SET_TOOL && random.chance(0.2);
    line.number = isNone ? 0 : some_tool(random, world.doings);
    if (line.kind == Kind::SET_TOOL) {
        line.values[2] = random.whole(-10, 10) * (world.modes.isInch ? 0.02 : 0.5);
    }
    return line;
}

}  // namespace

double Doings::z_of(int tool) const {
    for (const Tool &one : tools) {
        if (one.number == tool) {
            return one.z;
        }
    }
    return 0;
}

bool Doings::has(int tool) const {
    return std::ranges::any_of(tools, [tool](const Tool &one) { return one.number == tool; });
}

void Doings::load(int tool) {
    if (isRandom) {
        int pocket = 0;
        for (Tool &one : tools) {
            if (one.number == tool) {
                pocket = std::exchange(one.pocket, 0);
            }
        }
        for (Tool &one : tools) {
            one.pocket = one.number == in_spindle && in_spindle != tool ? pocket : one.pocket;
        }
    }
    in_spindle = tool;
}

std::string Line::text() const {
    return (isSkippable ? "/" : "") + plain_text(*this);
}

bool apply(const Line &line, World &world, bool isBlockDelete) {
    Modes &m = world.modes;
    if (line.isSkippable && isBlockDelete) {
        return true;
    }
    switch (line.kind) {
    case Kind::RAPID: return move(line, world);
    case Kind::FEED: m.feed_mm_min = line.number * unit(m); return move(line, world);
    case Kind::ABSOLUTE: m.isAbsolute = true; return true;
    case Kind::INCREMENTAL: m.isAbsolute = false; return true;
    case Kind::INCH: m.isInch = true; return true;
    case Kind::MM: m.isInch = false; return true;
    case Kind::KEEP: m.kept = *line.values[0]; return true;
    case Kind::WRONG: return false;
    default: return line.kind >= Kind::SET_TOOL ? apply_device(line, world) : apply_offset(line, world);
    }
}

void end_program(World &world) {
    world.modes.system = 1;
    world.modes.isAbsolute = true;
    world.modes.feed_mm_min = 0;
    world.doings.direction = 0;
    world.doings.turning_rpm = 0;
    world.doings.isMist = world.doings.isFlood = false;
}

World after_crash(const World &kept) {
    World out;
    const Modes &m = kept.modes;
    out.modes.system = m.system;
    out.modes.systems = m.systems;
    out.modes.kept_g92 = m.kept_g92;
    out.modes.isG92On = m.isG92On;
    out.modes.g28 = m.g28;
    out.modes.g30 = m.g30;
    out.modes.kept = m.kept;
    for (Place *place : {&out.modes.kept_g92, &out.modes.g28, &out.modes.g30}) {
        std::ranges::transform(*place, place->begin(), rounded);
    }
    for (Place &system : out.modes.systems) {
        std::ranges::transform(system, system.begin(), rounded);
    }
    out.modes.g92 = m.isG92On ? out.modes.kept_g92 : Place{};
    out.doings.tools = kept.doings.tools;
    out.doings.isRandom = kept.doings.isRandom;
    out.doings.in_spindle = kept.doings.isRandom ? kept.doings.in_spindle : 0;
    return out;
}

Line make_line(plants::Random &random, const World &world) {
    Line line;
    const double choice = random.real(0, 1);
    if (choice < 0.42) {
        line.kind = random.chance(0.4) ? Kind::RAPID : Kind::FEED;
        line.number = static_cast<int>(world.modes.isInch ? FEED_MM_MIN / MM_PER_INCH : FEED_MM_MIN);
        give_axes(random, world, line);
    } else if (choice < 0.52) {
        static constexpr Kind KINDS[] = {Kind::ABSOLUTE, Kind::ABSOLUTE, Kind::INCREMENTAL, Kind::INCH,
                                         Kind::MM};
        line.kind = KINDS[random.whole(0, 4)];
    } else if (choice < 0.72) {
        line = make_offset_line(random, world);
    } else if (choice < 0.89) {
        line = make_device_line(random, world);
    } else {
        static constexpr Kind KINDS[] = {Kind::DWELL, Kind::STOP, Kind::OPTIONAL_STOP, Kind::REMARK};
        line.kind = KINDS[random.whole(0, 3)];
        line.values[0] = line.kind == Kind::DWELL ? std::optional(0.01 * random.whole(1, 12)) : std::nullopt;
    }
    line.isSkippable = random.chance(0.08);
    return line;
}

Line make_wrong_line(plants::Random &random) {
    static constexpr const char *TEXTS[] = {"T77 M6",  "G1 X[1/0] F100", "G43 H78",   "G2 X5 Y5 R0.001 F100",
                                            "M61 Q79", "G10 L2 P12 X0",  "G1 X1 F0 Q"};
    Line line;
    if (random.chance(0.2)) {
        line.kind = Kind::RAPID;
        line.values[0] = 9999;  // the soft limit is nearer
        return line;
    }
    line.kind = Kind::WRONG;
    line.wrong = TEXTS[random.whole(0, static_cast<int>(std::size(TEXTS)) - 1)];
    return line;
}

bool isSame(double a, double b) {
    constexpr double DIGITS_OF_A_FILE = 2e-5;  // several numbers with six digits after the point, added
    return std::abs(a - b) < DIGITS_OF_A_FILE;
}

namespace {

std::string differ(const char *what, double expected, double seen) {
    return isSame(expected, seen) ? "" : fmt::format("{} is {:.6g}, not {:.6g}", what, seen, expected);
}

std::string differ(const std::string &what, const Place &expected, const Place &seen) {
    for (std::size_t i = 0; i < AXES; ++i) {
        const std::string text =
            differ(fmt::format("{} of {}", what, LETTERS[i]).c_str(), expected[i], seen[i]);
        if (!text.empty()) {
            return text;
        }
    }
    return "";
}

}  // namespace

std::string difference(const Modes &expected, const Modes &seen) {
    std::string text = differ("the coordinate system", expected.system, seen.system);
    text = text.empty() ? differ("#3101", expected.kept, seen.kept) : text;
    for (std::size_t i = 0; i < SYSTEMS; ++i) {
        text = text.empty() ? differ(fmt::format("system {}", i + 1), expected.systems[i], seen.systems[i])
                            : text;
    }
    text = text.empty() ? differ("#5210", expected.isG92On, seen.isG92On) : text;
    text = text.empty() ? differ("#5211 and on", expected.kept_g92, seen.kept_g92) : text;
    text = text.empty() ? differ("G28", expected.g28, seen.g28) : text;
    return text.empty() ? differ("G30", expected.g30, seen.g30) : text;
}

std::string difference(const std::vector<Tool> &expected, const std::vector<Tool> &seen) {
    for (const Tool &tool : expected) {
        const auto found = std::ranges::find(seen, tool.number, &Tool::number);
        if (found == seen.end()) {
            return fmt::format("tool {} is gone", tool.number);
        }
        if (!isSame(found->z, tool.z) || found->pocket != tool.pocket) {
            return fmt::format("tool {} has pocket {} and Z {:.6g}, not {} and {:.6g}", tool.number,
                               found->pocket, found->z, tool.pocket, tool.z);
        }
    }
    return seen.size() == expected.size() ? ""
                                          : fmt::format("{} tools, not {}", seen.size(), expected.size());
}

}  // namespace mw::task_campaign
