// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/canon/print_canon.hh"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "base/text.hh"
#include "gcode/canon/call_text.hh"

namespace mw::gcode {
namespace {

constexpr std::string_view NO_NUMBER = "N.....";

}  // namespace

PrintCanon::PrintCanon(std::FILE *out) : out_(out), is_terminal_(::isatty(::fileno(out)) == 1) {
    head_.fill(' ');
    head_[COUNTER_WIDTH - 1] = '0';
    set_prefix(NO_NUMBER);
}

/// Increments the decimal digits of the counter in place.
void PrintCanon::count_line() {
    char *digit = &head_[COUNTER_WIDTH - 1];
    for (; *digit == '9'; --digit) {
        *digit = '0';
    }
    *digit = *digit == ' ' ? '1' : static_cast<char>(*digit + 1);
    head_begin_ = std::min(head_begin_, static_cast<std::size_t>(digit - head_.data()));
}

void PrintCanon::set_prefix(std::string_view prefix) {
    head_[COUNTER_WIDTH] = ' ';
    prefix.copy(&head_[COUNTER_WIDTH + 1], MOST_PREFIX);
    head_end_ = COUNTER_WIDTH + 1 + prefix.size();
    head_[head_end_++] = ' ';
}

void PrintCanon::begin_line() {
    count_line();
    line_.assign(&head_[head_begin_], head_end_ - head_begin_);
}

void PrintCanon::end_line() {
    if (is_terminal_) {
        line_ = printable(line_);  // control characters of a program must not reach a terminal
    }
    line_ += '\n';
    fwrite_unlocked(line_.data(), 1, line_.size(), out_);
}

void PrintCanon::put(std::string_view call) {
    begin_line();
    line_ += call;
    end_line();
}

void PrintCanon::begin_block(const BlockRef &block) {
    if (block.isNumbered) {
        set_prefix(fmt::format("N{:<5d}", block.sequence));
        prefix_numbered_ = true;
    } else if (prefix_numbered_) {
        set_prefix(NO_NUMBER);
        prefix_numbered_ = false;
    }
}

void PrintCanon::take(const CanonCall &call) {
    std::visit([this](const AlternativeOf<CanonCall> auto &one) { write(one); }, call);
}

template <RegularCall Call>
void PrintCanon::write(const Call &call) {
    begin_line();
    append_call(line_, call);
    end_line();
}

void PrintCanon::write(const OnReset &call) {
    begin_block({});
    write<OnReset>(call);
}

void PrintCanon::write(const Finish &call) {
    begin_block({});
    write<Finish>(call);
}

void PrintCanon::write(const UseToolLengthOffset &call) {
    const Pose &p = call.offset;
    put(fmt::format("{}({:.4f} {:.4f} {:.4f}, {:.4f} {:.4f} {:.4f}, {:.4f} {:.4f} {:.4f})", call.NAME, p[0],
                    p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]));
}

void PrintCanon::write(const SetFeedMode &call) {
    put(fmt::format("{}({}, {})", call.NAME, call.spindle,
                    call.mode == FeedMode::UNITS_PER_REVOLUTION ? 1 : 0));
}

void PrintCanon::write(const SetMotionControlMode &call) {
    const std::string_view mode = CALL_WORDS<geometry::PathMode>[static_cast<std::size_t>(call.mode)];
    put(call.mode == geometry::PathMode::BLEND
            ? fmt::format("{}({}, {:.6f})", call.NAME, mode, call.tolerance)
            : fmt::format("{}({})", call.NAME, mode));
}

void PrintCanon::write(const SetPlannerMode &call) {
    put(fmt::format("{}(type={}, peak_scale={:.6f})", call.NAME, call.type, call.peak_scale));
}

/// All moves of a program use this function, so short texts are copied in overlapping blocks of a fixed size.
template <class Call>
void PrintCanon::write_straight(const Call &call) {
    constexpr std::size_t MOST = 2304;  // prefix, name, and six coordinates of at most 317 characters
    constexpr std::size_t SHORT = 24;   // size of an ordinary coordinate
    char text[MOST];
    count_line();
    std::memcpy(text, &head_[head_begin_], MOST_HEAD);
    char *at = text + (head_end_ - head_begin_);
    std::memcpy(at, Call::NAME.data(), Call::NAME.size());
    at += Call::NAME.size();
    *at++ = '(';
    for (int i = 0; i < geometry::AXIS_U; ++i) {
        // Most moves change only a few coordinates, so the text of the others is reused.
        Coordinate &known = coordinates_[static_cast<std::size_t>(i)];
        const auto bits = std::bit_cast<std::uint64_t>(call.end[i]);
        if (bits != known.bits || known.length == 0) {
            known.bits = bits;
            known.length = write_fixed4(known.text, call.end[i]);
        }
        std::memcpy(at, known.text.data(), SHORT);
        if (known.length > SHORT) {
            std::memcpy(at, known.text.data(), known.length);
        }
        at += known.length;
        std::memcpy(at, ", ", 2);
        at += 2;
    }
    at -= 2;  // removes the last comma
    std::memcpy(at, ")\n", 2);
    at += 2;
    fwrite_unlocked(text, 1, static_cast<std::size_t>(at - text), out_);
}

void PrintCanon::write(const ArcFeed &arc) {
    begin_line();
    line_.append(arc.NAME).append(1, '(');
    for (const double value : {arc.first_end, arc.second_end, arc.first_centre, arc.second_centre}) {
        append_argument(line_, value);
        line_ += ", ";
    }
    append_argument(line_, arc.rotation);
    for (const double value : {arc.axis_end, arc.end[3], arc.end[4], arc.end[5]}) {
        line_ += ", ";
        append_argument(line_, value);
    }
    line_ += ')';
    end_line();
}

void PrintCanon::write(const NurbsFeed &call) {
    put(fmt::format("{}({}, ...)", call.NAME, call.points.size()));
}

void PrintCanon::write(const StraightProbe &call) {
    put("TURN_PROBE_ON()");
    write_straight(call);
    put("TURN_PROBE_OFF()");
}

void PrintCanon::write(const StartSpeedFeedSynch &call) {
    put(fmt::format("{}({:.6f},{})", call.NAME, call.feed_per_revolution, call.isVelocityMode ? 1 : 0));
}

void PrintCanon::write(const SetSpindleMode &call) {
    put(fmt::format("{}({} {:.4f})", call.NAME, call.spindle, call.css_max_rpm));
}

void PrintCanon::write(const WaitOrientComplete &call) {
    put(fmt::format("SPINDLE.{}.{}({:.4f})", call.spindle, call.NAME, call.timeout_s));
}

void PrintCanon::write(const SetToolTableEntry &call) {
    const ToolEntry &entry = call.entry;
    const Pose &p = entry.offset;
    put(fmt::format("{}({}, {}, {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f} {:.4f}, {:.4f}, "
                    "{:.4f}, {})",
                    call.NAME, call.index, entry.toolno, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8],
                    entry.frontangle, entry.backangle, entry.orientation));
}

void PrintCanon::write(const SetAnalogOutput &call) {
    put(fmt::format("{}({},{:.6f})", name_of(call), call.index, call.value));
}

void PrintCanon::write(const PrintLine &call) {
    fmt::print(out_, "{}\n", is_terminal_ ? printable(call.text) : call.text);
}

void PrintCanon::write(const CanonError &call) {
    put(fmt::format("{}({})", call.NAME, call.text));
}

}  // namespace mw::gcode
