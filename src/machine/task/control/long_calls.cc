// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/control/long_calls.hh"

#include <utility>

#include <fmt/format.h>

#include "gcode/interpreter/scripts/script_stop.hh"

namespace mw::task {

void LongCalls::step(const std::string &place) {
    constexpr std::int64_t REPORTED_AFTER_NS = 1000000000;
    const std::int64_t now_ns = port_.now_ns();
    if (!now_.active) {
        now_.active = true;
        now_.since_ns = now_ns;
    }
    if (!now_.reported && now_ns - now_.since_ns >= REPORTED_AFTER_NS) {
        now_.reported = true;
        port_.post(
            MessageKind::OPERATOR_TEXT,
            fmt::format("the interpreter has been busy for 1 s at or after {}: a slow disk, or Python. "
                        "Stops work; other commands wait until it has finished",
                        place));
    }
    if (now_.stopped && !now_.wait_reported && now_ns - now_.stopped_ns >= REPORTED_AFTER_NS) {
        now_.wait_reported = true;
        const std::string line = gcode::script_stop().place();
        port_.post_error(fmt::format(
            "the work is stopped, but the interpreter still waits{}: for a disk, or for a function "
            "outside of Python such as time.sleep(). Other commands wait until it returns; if it "
            "does not, end the machine",
            line.empty() ? "" : " at " + line));
    }
}

void LongCalls::note_stop(const Sequencer &sequencer) {
    reader_.call().fix_executed(sequencer);
    now_.stopped = true;
    now_.stopped_ns = port_.now_ns();
    gcode::script_stop().request();
}

void LongCalls::after_call(std::function<void()> work) {
    if (now_.active) {
        now_.later.push_back(std::move(work));
    } else {
        work();
    }
}

bool LongCalls::end() {
    if (!now_.active) {
        return false;
    }
    const State ended = std::exchange(now_, {});
    for (const auto &work : ended.later) {
        work();
    }
    reader_.call().fixed_executed.reset();
    return ended.stopped;
}

bool LongCalls::end_step(gcode::Step result) {
    const bool failed = now_.stopped && result == gcode::Step::FAILED;
    const std::string failure = failed ? reader_.interpreter().error().what.str() : std::string();
    const bool stopped = end();
    if (failed) {
        port_.post_error(failure);
    }
    return stopped;
}

}  // namespace mw::task
