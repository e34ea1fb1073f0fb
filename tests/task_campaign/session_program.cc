// SPDX-License-Identifier: GPL-2.0-or-later
// Programs, from their start or from a line, to their end, a stop or a crash, and the work after it.
#include <algorithm>

#include "task_campaign/after_stop.hh"
#include "task_campaign/session.hh"

namespace mw::task_campaign {
namespace {

constexpr std::int64_t RUN_PATIENCE_MS =
    300000;  // 300 mm of approach at 5 mm/s, at an override of 0.4, and the rest

std::string text_of(const std::vector<Line> &lines) {
    std::string text;
    for (const Line &line : lines) {
        text += line.text() + "\n";
    }
    return text + "M2\n";
}

std::vector<World> stopped_again(const std::vector<Line> &lines, const std::vector<World> &before,
                                 bool isBlockDelete) {
    std::vector<World> all;
    for (const World &world : before) {
        for (const World &one : after_stop(lines, world, isBlockDelete)) {
            add(all, one);
        }
    }
    return all;
}

/// Line at which it starts; 0: the start of the program.
std::size_t first_line_of(const Act &act) {
    return act.work == Work::FROM_LINE ? 1 + act.seed % (act.blocks.size() + 1) : 0;
}

}  // namespace

void Session::run_program(const Act &act) {
    if (!prepare(messages::Mode::AUTO)) {
        return;
    }
    ask(act.client, messages::OpenProgram{bench_.write_program(text_of(act.blocks))}, Expected::TAKEN);
    const int from = static_cast<int>(first_line_of(act));
    begin_troubles(act);
    ++verdict_.runs;
    const std::uint64_t ended = ended_before_ = status().task.programs_ended;
    const Serial run = post(act.client, messages::RunProgram{from}, Expected::ANY, RUN_PATIENCE_MS);
    constexpr int SOON_MS = 3;
    const auto isUnderWay = [&] {
        return isRunning() || isWaited(run) || bench_.now_ms() < began_ms_ + SOON_MS;
    };
    while (!isOver() && !isCrashed_ && isUnderWay()) {
        step_troubles();
        if (!isCrashed_) {
            nurse();
            cycle();
        }
        if (bench_.now_ms() > began_ms_ + RUN_PATIENCE_MS) {
            fail("end", "the program does not end");
        }
    }
    if (!isOver()) {
        end_program_of(act, isCrashed_ ? End::CRASHED : end_of(run, ended));
    }
}

Session::End Session::end_of(Serial run, std::uint64_t ended_before) const {
    const messages::Progress progress = progress_of(run);
    if (progress == messages::Progress::STARTED) {  // its client has ended: the end was not reported
        const bool isError = status().task.error_code != 0 || isStopped_;
        return isError || status().task.programs_ended == ended_before ? End::FAILED : End::DONE;
    }
    return progress == messages::Progress::DONE      ? End::DONE
           : progress == messages::Progress::REFUSED ? End::REFUSED
                                                     : End::FAILED;
}

void Session::end_program_of(const Act &act, End end) {
    if (end == End::CRASHED) {
        end_by_crash(act);
        return;
    }
    std::vector<World> whole, stopped;
    for (const World &world : beliefs_.worlds) {
        const auto after = carried_out(act.blocks, world, beliefs_.isBlockDelete, first_line_of(act));
        if (after.has_value()) {
            add(whole, *after);
        }
        for (const World &one : after_stop(act.blocks, world, beliefs_.isBlockDelete, first_line_of(act))) {
            add(stopped, one);
        }
        if (act.work == Work::FROM_LINE) {  // its search has failed, so nothing is changed
            add(stopped, world);
        }
    }
    if (end == End::DONE) {
        ++verdict_.ended;
        if (whole.empty()) {
            fail("work", "a program that must fail has ended normally");
        }
        beliefs_.worlds = std::move(whole);
    } else if (end == End::FAILED) {
        ++verdict_.stopped;
        const bool mayFail = isStopped_ || whole.size() < beliefs_.worlds.size();
        if (!mayFail && act.work != Work::FROM_LINE) {
            fail("work", "a program without a stop does not end");
        }
        // A late step has started it again.
        const std::uint64_t runs = status().task.programs_ended - ended_before_;
        for (std::uint64_t again = 1; again < runs; ++again) {
            stopped = stopped_again(act.blocks, stopped, beliefs_.isBlockDelete);
        }
        beliefs_.worlds = std::move(stopped);
    }
    if (end == End::REFUSED && !isStopped_ && act.work != Work::FROM_LINE) {
        fail("refusal", "a program that may run is rejected");
    }
    note_stop();
    if (end == End::FAILED) {
        adopt_place(bench_, beliefs_);
    }
}

/// The parameter file is as before the program; the tool table file has the state that the machine had
/// reached.
void Session::end_by_crash(const Act &act) {
    std::vector<World> before = std::move(beliefs_.worlds);
    beliefs_.worlds.clear();
    // A late step has started it again, from the state at its end.
    for (std::uint64_t again = 0; again < runs_before_crash_; ++again) {
        std::vector<World> left;
        for (const World &world : before) {
            for (const World &stopped : after_stop(act.blocks, world, wasBlockDelete_)) {
                add(left, stopped);
            }
        }
        before = std::move(left);
    }
    for (const World &world : before) {
        for (const World &stopped : after_stop(act.blocks, world, wasBlockDelete_, first_line_of(act))) {
            add(beliefs_.worlds, after_crash({world.modes, stopped.doings}));
            if (!wasRunning_) {  // it has just ended
                add(beliefs_.worlds, after_crash(stopped));
            }
        }
    }
    if (before.size() == 1) {
        recover(act, before[0], wasBlockDelete_);
    }
}

/// The program that the crash interrupted, if it is offered.
void Session::recover(const Act &act, const World &before, bool isBlockDelete) {
    const bool isOffered = status().recovery.isOffered;
    ++verdict_.counts[isOffered ? "offered after a crash" : "not offered after a crash"];
    if (!isOffered) {
        if (!status().recovery.refusal.str().empty()) {
            ++verdict_.counts["offer refused: " + std::string(status().recovery.refusal.str()).substr(0, 40)];
        }
        return;
    }
    settle();
    check();
    if (isOver() || !prepare(messages::Mode::AUTO)) {
        return;
    }
    if (act.seed % 4 == 0) {
        ask(3, messages::ForgetRecovery{}, Expected::TAKEN);
        return;
    }
    const Serial run = post(3, messages::RecoverProgram{}, Expected::ANY, RUN_PATIENCE_MS);
    while (!isOver() && progress_of(run) == messages::Progress::STARTED) {
        nurse();
        cycle();
    }
    if (isOver()) {
        return;
    }
    // The switches have their values of the start, from the confirmation of the approach on.
    const messages::TaskStatus &task = status().task;
    const bool areRestored = task.isBlockDelete == wasBlockDelete_ && task.isOptionalStop == wasOptionalStop_;
    if (progress_of(run) == messages::Progress::DONE || areRestored) {
        beliefs_.isBlockDelete = wasBlockDelete_;
        beliefs_.isOptionalStop = wasOptionalStop_;
    }
    const auto whole = carried_out(act.blocks, before, isBlockDelete, first_line_of(act));
    if (progress_of(run) == messages::Progress::DONE) {
        ++verdict_.recovered;
        if (!whole.has_value()) {
            fail("work", "a program that must fail has ended normally after a crash");
            return;
        }
        beliefs_.worlds = {*whole};
        return;
    }
    for (const World &one : after_stop(act.blocks, before, isBlockDelete, 1)) {
        add(beliefs_.worlds, one);
    }
    beliefs_.switch_devices_off();
    settle();
    adopt_place(bench_, beliefs_);
}

}  // namespace mw::task_campaign
