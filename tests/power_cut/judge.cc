// SPDX-License-Identifier: GPL-2.0-or-later
#include "power_cut/judge.hh"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "power_cut/programs.hh"
#include "power_cut/rig.hh"

namespace mw::power_cut {
namespace {

namespace files = std::filesystem;

constexpr std::size_t MOST_CYCLES = 400000;
constexpr std::size_t A_SECOND = 1000;  ///< in cycles of task
/// Moves of the approach, including those of a tool change.
constexpr std::size_t MOST_APPROACH_MOVES = 8;

/// The whole program without a power cut.
Recording run_undisturbed(const Job &job, const files::path &folder, std::string &trouble) {
    journal::test::TornDisk disk;
    Rig rig(folder, disk);
    std::mt19937_64 random(0);
    trouble = rig.come_up(job.mdi);
    trouble = trouble.empty() ? rig.begin(job.program) : trouble;
    while (trouble.empty() && !rig.hasEnded() && rig.recording.under_tool.size() < MOST_CYCLES) {
        rig.cycle(random);
    }
    trouble = trouble.empty() && !rig.recording.isDone ? "the program fails: " + rig.outcome() : trouble;
    return rig.recording;
}

/// The skipped part, and the part cut more than a second before the power cut that is repeated.
std::string check_place(const Recording &whole, std::size_t cut, std::uint64_t offered, int &late_ms) {
    const auto &under = whole.under_tool;
    for (std::size_t i = cut + 1; i < under.size(); ++i) {
        if (under[i] != 0 && under[i] < offered) {
            return fmt::format("block {} is offered, and block {} was not done", offered, under[i]);
        }
    }
    std::map<std::uint32_t, std::size_t> ends;
    for (std::size_t i = 0; i < under.size(); ++i) {
        ends[under[i]] = i;
    }
    std::size_t first = cut;  // time at which the first repeated block was done
    for (const auto &[block, end] : ends) {
        first = block != 0 && block >= offered ? std::min(first, end) : first;
    }
    late_ms = static_cast<int>(cut - first);
    return first + A_SECOND < cut
               ? fmt::format("block {} is offered, {} ms of cutting before the tool", offered, late_ms)
               : "";
}

std::string check_calls(const Recording &whole, const Recording &rest, std::uint64_t offered) {
    const auto from = std::ranges::find_if(whole.calls, [&](const Call &c) { return c.block >= offered; });
    const auto expected = static_cast<std::size_t>(whole.calls.end() - from);
    if (rest.calls.size() < expected || rest.calls.size() > expected + MOST_APPROACH_MOVES) {
        return fmt::format("{} moves from block {} on, {} were due", rest.calls.size(), offered, expected);
    }
    auto at = rest.calls.end() - static_cast<std::ptrdiff_t>(expected);
    for (auto due = from; due != whole.calls.end(); ++due, ++at) {
        if (!(*at == *due)) {
            return fmt::format("from block {} on: block {} '{}', due is block {} '{}'", offered, at->block,
                               at->bits, due->block, due->bits);
        }
    }
    return rest.parameters == whole.parameters ? "" : "other parameters at the end";
}

/// Runs until the power cut and loses power; true if the program has ended before.
bool cut_short(const Job &job, Rig &rig, std::mt19937_64 &random, std::size_t cut, const Recording &whole,
               std::string &trouble) {
    trouble = rig.come_up(job.mdi);
    trouble = trouble.empty() ? rig.begin(job.program) : trouble;
    if (!trouble.empty()) {
        return false;
    }
    for (std::size_t i = 0; i <= cut && !rig.hasEnded(); ++i) {
        rig.steps_in_write = i == cut && random() % 2 == 0 ? static_cast<long>(random() % 5) : -1;
        rig.cycle(random);
    }
    const bool isSame = std::equal(rig.recording.under_tool.begin(), rig.recording.under_tool.end(),
                                   whole.under_tool.begin());
    trouble = isSame ? "" : "two runs of one program differ";
    return rig.hasEnded();
}

}  // namespace

Verdict judge_power_cut(std::uint64_t seed, const files::path &folder) {
    std::mt19937_64 random(seed);
    const Job job = make_job(random);
    Verdict verdict;
    files::remove_all(folder);
    const Recording whole = run_undisturbed(job, folder, verdict.trouble);
    if (verdict.trouble.contains("exceeds the soft limit")) {  // random offsets: no program to judge
        return {"no program", "", 0};
    }
    if (!verdict.trouble.empty()) {
        return verdict;
    }
    files::remove_all(folder);
    const std::size_t cut = random() % whole.under_tool.size();
    journal::test::TornDisk disk;
    Rig rig(folder, disk);
    const bool hasEnded = cut_short(job, rig, random, cut, whole, verdict.trouble);
    disk.isDead = true;
    rig.die();
    disk.cut_power(random);
    verdict.trouble = verdict.trouble.empty() ? rig.come_up({}) : verdict.trouble;
    if (!verdict.trouble.empty()) {
        return verdict;
    }
    const messages::RecoveryStatus recovery = rig.status().recovery;
    if (!recovery.isOffered) {
        verdict.kind = !recovery.program.empty() ? "refused: " + recovery.refusal.str()
                       : hasEnded                ? "ended"
                                                 : "not begun";
        verdict.trouble = hasEnded ? "" : check_place(whole, cut, 1, verdict.late_ms);
        return verdict;
    }
    verdict.kind = "offered";
    verdict.trouble = check_place(whole, cut, recovery.block, verdict.late_ms);
    verdict.trouble = verdict.trouble.empty() ? rig.recover() : verdict.trouble;
    while (verdict.trouble.empty() && !rig.hasEnded() && rig.recording.under_tool.size() < MOST_CYCLES) {
        rig.cycle(random);
    }
    verdict.trouble = !verdict.trouble.empty() ? verdict.trouble
                      : rig.recording.isDone   ? check_calls(whole, rig.recording, recovery.block)
                                               : "it does not end: " + rig.outcome();
    return verdict;
}

}  // namespace mw::power_cut
