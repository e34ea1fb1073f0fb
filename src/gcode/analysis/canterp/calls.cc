// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/canterp/calls.hh"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::gcode::canterp {
namespace {

constexpr std::string_view BLANKS = " \t\r";

/// Reads arguments in order; blanks and commas separate them.
class Arguments {
  public:
    Arguments(const Call &call, Plane in_plane) : plane(in_plane), call_(call), rest_(call.arguments) {}

    const Plane plane;  ///< plane selected by the calls read so far

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
        for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
            if (axis == 6 && !hasMore()) {
                break;
            }
            out[axis] = number();
        }
        return out;
    }
    /// Index of one of the words.
    template <class Enum>
    Enum choice(std::span<const std::string_view> words) {
        const std::string_view word = next_word();
        const auto found = std::find(words.begin(), words.end(), word);
        if (found != words.end()) {
            return static_cast<Enum>(found - words.begin());
        }
        if (error_.empty()) {
            error_ = fmt::format("'{}' is not known here", word);
            offset_ = word.empty() ? call_.arguments_offset : offset_of(word);
        }
        return {};
    }
    /// The whole argument as text, without quotes.
    std::string_view text() {
        std::string_view out = call_.arguments;
        if (out.size() >= 2 && out.front() == '"' && out.back() == '"') {
            out = out.substr(1, out.size() - 2);
        }
        rest_ = {};
        return out;
    }
    void read(int &field) { field = whole(); }
    void read(double &field) { field = number(); }
    void read(Pose &field) { field = pose(); }
    void read(std::string &field) { field = text(); }
    template <class Enum>
        requires std::is_enum_v<Enum>
    void read(Enum &field) {
        field = choice<Enum>(CALL_WORDS<Enum>);
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

using Reader = CanonCall (*)(Arguments &in);

/// A call made from its FIELDS; `choices` are the values that its name determines.
template <RegularCall Made, bool... choices>
CanonCall regular(Arguments &in) {
    Made call;
    if constexpr (sizeof...(choices) > 0) {
        std::apply([&](auto... field) { ((call.*field = choices), ...); }, Made::CHOICES);
    }
    std::apply([&](auto... field) { (in.read(call.*field), ...); }, Made::FIELDS);
    return call;
}

CanonCall arc_feed(Arguments &in) {
    ArcFeed arc;
    arc.first_end = in.number();
    arc.second_end = in.number();
    arc.first_centre = in.number();
    arc.second_centre = in.number();
    arc.rotation = in.whole();
    arc.axis_end = in.number();
    // First, second and normal axis of each plane, in the canon's numbering.
    constexpr int AXES[3][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}};
    const int *const axes = AXES[in.plane == Plane::XY ? 0 : (in.plane == Plane::YZ ? 1 : 2)];
    arc.end[axes[0]] = arc.first_end;
    arc.end[axes[1]] = arc.second_end;
    arc.end[axes[2]] = arc.axis_end;
    for (int axis = 3; axis < geometry::AXIS_COUNT && (axis < 6 || in.hasMore()); ++axis) {
        arc.end[axis] = in.number();
    }
    return arc;
}

CanonCall select_plane(Arguments &in) {
    constexpr std::size_t NAMED_PLANES = 3;
    return SelectPlane{in.choice<Plane>(std::span(CALL_WORDS<Plane>).first<NAMED_PLANES>())};
}

CanonCall motion_control(Arguments &in) {
    SetMotionControlMode call;
    in.read(call.mode);
    call.tolerance = in.hasMore() ? in.number() : 0.0;
    return call;
}

CanonCall feed_mode(Arguments &in) {
    SetFeedMode call;
    in.read(call.spindle);
    const int mode = in.whole();
    call.mode = static_cast<FeedMode>(mode >= 0 && mode <= 2 ? mode : 0);
    return call;
}

CanonCall tool_length_offset(Arguments &in) {
    return UseToolLengthOffset{in.pose()};
}

CanonCall canon_error(Arguments &in) {
    return CanonError{std::string(in.text())};
}

struct Row {
    std::string_view name;
    Reader read;
};

template <RegularCall Made>
constexpr Row row() {
    return {Made::NAME, &regular<Made>};
}
template <RegularCall Made, bool choice>
constexpr Row row() {
    return {Made::NAMES[choice ? 1 : 0], &regular<Made, choice>};
}

constexpr Row ROWS[] = {
    {ArcFeed::NAME, &arc_feed},
    {CanonError::NAME, &canon_error},
    row<ChangeTool>(),
    row<ChangeToolNumber>(),
    row<ProgramComment>(),
    row<SwitchFeedOverride, false>(),
    row<SwitchSpeedOverride, false>(),
    row<Dwell>(),
    row<SwitchFeedOverride, true>(),
    row<SwitchSpeedOverride, true>(),
    row<Finish>(),
    row<SwitchFlood, false>(),
    row<SwitchFlood, true>(),
    row<OperatorMessage>(),
    row<SwitchMist, false>(),
    row<SwitchMist, true>(),
    row<OnReset>(),
    row<ProgramStop, true>(),
    row<PalletShuttle>(),
    row<ProgramEnd>(),
    row<ProgramStop, false>(),
    {SelectPlane::NAME, &select_plane},
    row<SelectTool>(),
    {SetFeedMode::NAME, &feed_mode},
    row<SetFeedRate>(),
    row<SetFeedReference>(),
    row<SetG5xOffset>(),
    row<SetG92Offset>(),
    {SetMotionControlMode::NAME, &motion_control},
    row<SetNaivecamTolerance>(),
    row<SetSpindleMode>(),
    row<SetSpindleSpeed>(),
    row<SetXyRotation>(),
    row<StartSpindle, true>(),
    row<StartSpindle, false>(),
    row<StopSpindle>(),
    row<StraightFeed>(),
    row<StraightTraverse>(),
    row<UseLengthUnits>(),
    {UseToolLengthOffset::NAME, &tool_length_offset},
};

/// The next word of `line` from `at`; moves `at` after the word.
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
            Arguments in(call, plane);
            const CanonCall made = row.read(in);
            if (Result<> done = in.finish(); !done) {
                return done;
            }
            if (const auto *selected = std::get_if<SelectPlane>(&made)) {
                plane = selected->plane;
            }
            canon.take(made);
            return {};
        }
    }
    return fail(fmt::format("there is no canon call {}", call.name),
                {{}, 0, static_cast<int>(call.name_offset) + 1});
}

}  // namespace mw::gcode::canterp
