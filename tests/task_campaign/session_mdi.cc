// SPDX-License-Identifier: GPL-2.0-or-later
// Lines of MDI, entered at once or one after the other.
#include <algorithm>

#include "task_campaign/after_stop.hh"
#include "task_campaign/session.hh"

namespace mw::task_campaign {
namespace {

constexpr std::int64_t LINE_PATIENCE_MS = 120000;

}  // namespace

void Session::step_mdi(std::vector<Typed> &typed) {
    step_troubles();
    if (!isCrashed_) {
        nurse();
        cycle();
    }
    for (Typed &one : typed) {
        const bool isDone = one.done_ms < 0 && progress_of(one.serial) == messages::Progress::DONE;
        one.done_ms = isDone ? bench_.now_ms() : one.done_ms;
    }
}

void Session::run_mdi(const Act &act) {
    if (!prepare(messages::Mode::MDI)) {
        return;
    }
    begin_troubles(act);
    ++verdict_.runs;
    std::vector<Typed> typed;
    for (const Line &line : act.blocks) {
        if (isOver() || isStopped_) {
            break;
        }
        typed.push_back({post(act.client, messages::Mdi{line.text()}, Expected::ANY, LINE_PATIENCE_MS)});
        tell("  " + line.text());
        while (act.isLineTypedLate && !isOver() && !isCrashed_ && isWaited(typed.back().serial)) {
            step_mdi(typed);
        }
    }
    const auto isUnderWay = [&] {
        return isRunning() ||
               std::ranges::any_of(typed, [this](const Typed &one) { return isWaited(one.serial); });
    };
    while (!isOver() && !isCrashed_ && isUnderWay()) {
        step_mdi(typed);
    }
    std::vector<World> now = beliefs_.worlds;
    for (std::size_t i = 0; i < typed.size() && !isOver(); ++i) {
        now = after_line(act.blocks[i], typed[i], now);
        if (now.empty()) {
            fail("work", "a line that must fail is done: " + act.blocks[i].text());
        }
    }
    if (isOver()) {
        return;
    }
    beliefs_.worlds = std::move(now);
    if (isCrashed_) {
        std::ranges::for_each(beliefs_.worlds, [](World &world) { world = after_crash(world); });
        return;
    }
    note_stop();
    const bool isAllDone = std::ranges::all_of(typed, [](const Typed &one) { return one.done_ms >= 0; });
    if (!isAllDone) {
        adopt_place(bench_, beliefs_);
    }
}

/// Empty if the line ended with an unexpected result.
std::vector<World> Session::after_line(const Line &line, const Typed &typed,
                                       const std::vector<World> &before) {
    const messages::Progress progress = progress_of(typed.serial);
    // The writer may not have had the time to save the settings.
    const bool isLate = isCrashed_ && typed.done_ms + Bench::MOST_LATE_MS >= bench_.now_ms();
    std::vector<World> all;
    for (const World &world : before) {
        World after = world;
        const bool isRight = apply(line, after, false);
        if (typed.done_ms >= 0 && !isLate) {
            if (isRight) {
                add(all, after);
            }
        } else if (progress == messages::Progress::REFUSED) {
            add(all, world);
        } else {
            for (const World &one : with_or_without(line, world)) {
                add(all, one);
            }
            if (progress == messages::Progress::STARTED) {  // its client has ended: the end was not reported
                add(all, after);
            }
            const bool isFailure = progress == messages::Progress::FAILED && isRight && !isStopped_;
            if (isFailure && before.size() == 1) {
                fail("work", "a line without a stop fails: " + line.text());
            }
        }
    }
    return all;
}

}  // namespace mw::task_campaign
