// SPDX-License-Identifier: GPL-2.0-or-later
#include "interp/canterp/calls.hh"

#include <cmath>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::interp::canterp {
namespace {

constexpr std::string_view BLANKS = " \t\r";

/// Reads arguments one after the other; blanks and commas separate them.
class Arguments {
  public:
    Arguments(const Call &call, Plane &in_plane) : plane(in_plane), call_(call), rest_(call.arguments) {}

    Plane &plane;  ///< selected by the calls before

    std::string_view next_word() {
        const std::size_t begin = rest_.find_first_not_of(" \t,");
        if (begin == std::string_view::npos) {
            rest_ = {};
            return {};
        }
        const std::size_t end = std::min(rest_.find_first_of(" \t,", begin), rest_.size());
        const std::string_view word = rest_.substr(begin, end - begin);
        rest_.remove_prefix(end);
        return word;
    }
    bool hasMore() const { return rest_.find_first_not_of(" \t,") != std::string_view::npos; }
    double number() {
        const std::string_view word = next_word();
        const auto value = parse_double(word);
        if (!value && error_.empty()) {
            error_ = word.empty() ? "an argument is missing" : fmt::format("'{}' is not a number", word);
            offset_ = word.empty() ? call_.arguments_offset + call_.arguments.size() : offset_of(word);
        }
        return value.value_or(0.0);
    }
    int whole() {
        const double value = number();
        return std::fabs(value) < 1e9 ? static_cast<int>(std::lround(value)) : 0;
    }
    /// Six coordinates (X to C) or nine.
    Pose pose() {
        Pose out;
        for (int axis = 0; axis < geom::AXIS_COUNT; ++axis) {
            if (axis == 6 && !hasMore()) {
                break;
            }
            out[axis] = number();
        }
        return out;
    }
    /// One of the names; its place among them.
    int choice(std::initializer_list<std::string_view> names) {
        const std::string_view word = next_word();
        int index = 0;
        for (const std::string_view name : names) {
            if (word == name) {
                return index;
            }
            ++index;
        }
        if (error_.empty()) {
            error_ = fmt::format("'{}' is not known here", word);
            offset_ = word.empty() ? call_.arguments_offset : offset_of(word);
        }
        return 0;
    }
    /// All of the arguments as text, without quotes around it.
    std::string_view text() {
        std::string_view out = call_.arguments;
        if (out.size() >= 2 && out.front() == '"' && out.back() == '"') {
            out = out.substr(1, out.size() - 2);
        }
        rest_ = {};
        return out;
    }
    Result<> finish() const {
        if (!error_.empty()) {
            return fail(error_, {{}, 0, static_cast<int>(offset_) + 1});
        }
        if (hasMore()) {
            return fail(fmt::format("{} has too many arguments", call_.name),
                        {{}, 0, static_cast<int>(call_.arguments_offset) + 1});
        }
        return {};
    }

  private:
    std::size_t offset_of(std::string_view word) const {
        return call_.arguments_offset + static_cast<std::size_t>(word.data() - call_.arguments.data());
    }
    const Call &call_;
    std::string_view rest_;
    std::string error_;
    std::size_t offset_ = 0;
};

using Handler = void (*)(Arguments &in, Canon &canon, bool isMade);

/// Reads the arguments first; the call is made only when all of them are right.
template <auto Member>
void plain(Arguments &, Canon &canon, bool isMade) {
    if (isMade) {
        (canon.*Member)();
    }
}
template <auto Member>
void with_int(Arguments &in, Canon &canon, bool isMade) {
    const int value = in.whole();
    if (isMade) {
        (canon.*Member)(value);
    }
}
template <auto Member>
void with_number(Arguments &in, Canon &canon, bool isMade) {
    const double value = in.number();
    if (isMade) {
        (canon.*Member)(value);
    }
}
template <auto Member>
void with_pose(Arguments &in, Canon &canon, bool isMade) {
    const Pose value = in.pose();
    if (isMade) {
        (canon.*Member)(value);
    }
}
template <auto Member>
void with_text(Arguments &in, Canon &canon, bool isMade) {
    const std::string_view value = in.text();
    if (isMade) {
        (canon.*Member)(value);
    }
}
template <auto Member>
void with_int_and_number(Arguments &in, Canon &canon, bool isMade) {
    const int index = in.whole();
    const double value = in.number();
    if (isMade) {
        (canon.*Member)(index, value);
    }
}

void arc_feed(Arguments &in, Canon &canon, bool isMade) {
    ArcFeed arc;
    arc.first_end = in.number();
    arc.second_end = in.number();
    arc.first_centre = in.number();
    arc.second_centre = in.number();
    arc.rotation = in.whole();
    arc.axis_end = in.number();
    // First, second and normal axis of each plane, as the canon numbers them.
    constexpr int AXES[3][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
    const int *const axes = AXES[in.plane == Plane::XY ? 0 : (in.plane == Plane::YZ ? 1 : 2)];
    arc.end[axes[0]] = arc.first_end;
    arc.end[axes[1]] = arc.second_end;
    arc.end[axes[2]] = arc.axis_end;
    for (int axis = 3; axis < geom::AXIS_COUNT && (axis < 6 || in.hasMore()); ++axis) {
        arc.end[axis] = in.number();
    }
    if (isMade) {
        canon.arc_feed(arc);
    }
}

void length_units(Arguments &in, Canon &canon, bool isMade) {
    const int index = in.choice({"CANON_UNITS_INCHES", "CANON_UNITS_MM"});
    if (isMade) {
        canon.use_length_units(index == 0 ? LengthUnits::INCH : LengthUnits::MM);
    }
}

void select_plane(Arguments &in, Canon &canon, bool isMade) {
    const int index = in.choice({"CANON_PLANE_XY", "CANON_PLANE_YZ", "CANON_PLANE_XZ"});
    if (isMade) {
        in.plane = static_cast<Plane>(index);
        canon.select_plane(in.plane);
    }
}

void feed_reference(Arguments &in, Canon &canon, bool isMade) {
    in.choice({"CANON_XYZ"});
    if (isMade) {
        canon.set_feed_reference_xyz();
    }
}

void motion_control(Arguments &in, Canon &canon, bool isMade) {
    const int index = in.choice({"CANON_EXACT_STOP", "CANON_EXACT_PATH", "CANON_CONTINUOUS"});
    const double tolerance = in.hasMore() ? in.number() : 0.0;
    if (isMade) {
        canon.set_motion_control_mode(static_cast<MotionControl>(index), tolerance);
    }
}

void g5x_offset(Arguments &in, Canon &canon, bool isMade) {
    const int index = in.whole();
    const Pose offset = in.pose();
    if (isMade) {
        canon.set_g5x_offset(index, offset);
    }
}

void feed_mode(Arguments &in, Canon &canon, bool isMade) {
    const int spindle = in.whole();
    const int mode = in.whole();
    if (isMade) {
        canon.set_feed_mode(spindle, static_cast<FeedMode>(mode >= 0 && mode <= 2 ? mode : 0));
    }
}

template <bool isClockwise>
void start_spindle(Arguments &in, Canon &canon, bool isMade) {
    const int spindle = in.whole();
    if (isMade) {
        isClockwise ? canon.start_spindle_clockwise(spindle, true)
                    : canon.start_spindle_counterclockwise(spindle, true);
    }
}

struct Row {
    std::string_view name;
    Handler handler;
};

constexpr Row ROWS[] = {
    {"ARC_FEED", &arc_feed},
    {"CANON_ERROR", &with_text<&Canon::canon_error>},
    {"CHANGE_TOOL", &plain<&Canon::change_tool>},
    {"CHANGE_TOOL_NUMBER", &with_int<&Canon::change_tool_number>},
    {"COMMENT", &with_text<&Canon::comment>},
    {"DISABLE_FEED_OVERRIDE", &plain<&Canon::disable_feed_override>},
    {"DISABLE_SPEED_OVERRIDE", &with_int<&Canon::disable_speed_override>},
    {"DWELL", &with_number<&Canon::dwell>},
    {"ENABLE_FEED_OVERRIDE", &plain<&Canon::enable_feed_override>},
    {"ENABLE_SPEED_OVERRIDE", &with_int<&Canon::enable_speed_override>},
    {"FINISH", &plain<&Canon::finish>},
    {"FLOOD_OFF", &plain<&Canon::flood_off>},
    {"FLOOD_ON", &plain<&Canon::flood_on>},
    {"MESSAGE", &with_text<&Canon::message>},
    {"MIST_OFF", &plain<&Canon::mist_off>},
    {"MIST_ON", &plain<&Canon::mist_on>},
    {"ON_RESET", &plain<&Canon::on_reset>},
    {"OPTIONAL_PROGRAM_STOP", &plain<&Canon::optional_program_stop>},
    {"PALLET_SHUTTLE", &plain<&Canon::pallet_shuttle>},
    {"PROGRAM_END", &plain<&Canon::program_end>},
    {"PROGRAM_STOP", &plain<&Canon::program_stop>},
    {"SELECT_PLANE", &select_plane},
    {"SELECT_TOOL", &with_int<&Canon::select_tool>},
    {"SET_FEED_MODE", &feed_mode},
    {"SET_FEED_RATE", &with_number<&Canon::set_feed_rate>},
    {"SET_FEED_REFERENCE", &feed_reference},
    {"SET_G5X_OFFSET", &g5x_offset},
    {"SET_G92_OFFSET", &with_pose<&Canon::set_g92_offset>},
    {"SET_MOTION_CONTROL_MODE", &motion_control},
    {"SET_NAIVECAM_TOLERANCE", &with_number<&Canon::set_naivecam_tolerance>},
    {"SET_SPINDLE_MODE", &with_int_and_number<&Canon::set_spindle_mode>},
    {"SET_SPINDLE_SPEED", &with_int_and_number<&Canon::set_spindle_speed>},
    {"SET_XY_ROTATION", &with_number<&Canon::set_xy_rotation>},
    {"START_SPINDLE_CLOCKWISE", &start_spindle<true>},
    {"START_SPINDLE_COUNTERCLOCKWISE", &start_spindle<false>},
    {"STOP_SPINDLE_TURNING", &with_int<&Canon::stop_spindle_turning>},
    {"STRAIGHT_FEED", &with_pose<&Canon::straight_feed>},
    {"STRAIGHT_TRAVERSE", &with_pose<&Canon::straight_traverse>},
    {"USE_LENGTH_UNITS", &length_units},
    {"USE_TOOL_LENGTH_OFFSET", &with_pose<&Canon::use_tool_length_offset>},
};

/// The next word of `line` from `at` on, which moves behind it.
std::string_view word_at(std::string_view line, std::size_t &at, std::string_view ends) {
    const std::size_t begin = line.find_first_not_of(BLANKS, at);
    if (begin == std::string_view::npos) {
        at = line.size();
        return {};
    }
    at = std::min(line.find_first_of(ends, begin), line.size());
    return line.substr(begin, at - begin);
}

}  // namespace

Kind take_apart(std::string_view line, Call &call) {
    if (line.find_first_not_of(BLANKS) == std::string_view::npos) {
        return Kind::NOTHING;
    }
    std::size_t at = 0;
    word_at(line, at, BLANKS);
    word_at(line, at, BLANKS);
    call.name = word_at(line, at, "( \t\r");
    const std::size_t open = line.find('(', at);
    const std::size_t close = line.rfind(')');
    if (call.name.empty() || open == std::string_view::npos || close == std::string_view::npos ||
        close < open) {
        return Kind::BAD;
    }
    call.name_offset = static_cast<std::size_t>(call.name.data() - line.data());
    call.arguments_offset = open + 1;
    call.arguments = line.substr(open + 1, close - open - 1);
    return Kind::CALL;
}

Result<> make_call(const Call &call, Canon &canon, Plane &plane) {
    for (const Row &row : ROWS) {
        if (row.name == call.name) {
            Arguments checked(call, plane);
            row.handler(checked, canon, false);
            if (Result<> done = checked.finish(); !done) {
                return done;
            }
            Arguments used(call, plane);
            row.handler(used, canon, true);
            return {};
        }
    }
    return fail(fmt::format("there is no canon call {}", call.name),
                {{}, 0, static_cast<int>(call.name_offset) + 1});
}

}  // namespace mw::interp::canterp
