// SPDX-License-Identifier: GPL-2.0-or-later
#include "task_campaign/plan.hh"

#include <algorithm>
#include <iterator>

#include "campaign_runner/kept.hh"

namespace mw::task_campaign {
namespace {

/// Lines are planned as if the previous state were known; the actual state does not matter.
std::vector<Line> make_lines(plants::Random &random, World world, int count) {
    std::vector<Line> lines;
    for (int i = 0; i < count; ++i) {
        lines.push_back(make_line(random, world));
        apply(lines.back(), world, false);
    }
    return lines;
}

Work some_work(plants::Random &random) {
    static constexpr struct {
        Work work;
        int weight;
    } WEIGHTS[] = {{Work::PROGRAM, 30}, {Work::FROM_LINE, 8}, {Work::MDI, 26},    {Work::SWITCHES, 5},
                   {Work::BY_HAND, 5},  {Work::JOG, 4},       {Work::HOME, 3},    {Work::TABLE, 5},
                   {Work::STATE, 4},    {Work::ODD, 8},       {Work::OPERATE, 5}, {Work::CRASH, 4}};
    int total = 0;
    for (const auto &one : WEIGHTS) {
        total += one.weight;
    }
    int left = random.whole(0, total - 1);
    for (const auto &one : WEIGHTS) {
        left -= one.weight;
        if (left < 0) {
            return one.work;
        }
    }
    return Work::ODD;
}

Trouble make_trouble(plants::Random &random, bool isEnd, int span_ms) {
    static constexpr Upset PASSING[] = {Upset::PAUSE,    Upset::PAUSE, Upset::STEP, Upset::LEAVE,
                                        Upset::OVERRIDE, Upset::ODD,   Upset::ODD,  Upset::CLIENT_GONE};
    static constexpr Upset ENDING[] = {Upset::ABORT,  Upset::ABORT,         Upset::ABORT,
                                       Upset::OFF,    Upset::ESTOP,         Upset::CHAIN,
                                       Upset::KILLED, Upset::CHANGER_FAULT, Upset::POWER_CUT};
    Trouble t;
    t.what = isEnd ? ENDING[random.whole(0, static_cast<int>(std::size(ENDING)) - 1)]
                   : PASSING[random.whole(0, static_cast<int>(std::size(PASSING)) - 1)];
    t.at_ms = random.whole(0, random.chance(0.3) ? 20 : span_ms);
    t.length_ms = random.whole(1, 120);
    t.client = random.whole(0, CLIENTS - 1);
    t.seed = random.next();
    return t;
}

bool isRun(Work work) {
    return work == Work::PROGRAM || work == Work::FROM_LINE || work == Work::MDI;
}

Act make_act(plants::Random &random, const World &world) {
    Act act;
    act.work = some_work(random);
    act.client = random.whole(0, CLIENTS - 1);
    act.seed = random.next();
    if (!isRun(act.work)) {
        return act;
    }
    const bool isMdi = act.work == Work::MDI;
    act.blocks = make_lines(random, world, isMdi ? random.whole(1, 5) : random.whole(4, 22));
    act.isLineTypedLate = random.chance(0.5);
    for (Line &line : act.blocks) {
        line.isSkippable = line.isSkippable && !isMdi;
        const bool isStop = line.kind == Kind::STOP || line.kind == Kind::OPTIONAL_STOP;
        line = isMdi && isStop ? Line{} : line;
    }
    if (random.chance(0.1)) {
        act.blocks[static_cast<std::size_t>(random.whole(0, static_cast<int>(act.blocks.size()) - 1))] =
            make_wrong_line(random);
    }
    const int span_ms = isMdi ? 150 : 800;
    while (random.chance(0.4)) {
        act.troubles.push_back(make_trouble(random, false, span_ms));
    }
    if (random.chance(0.5)) {
        act.troubles.push_back(make_trouble(random, true, span_ms));
    }
    std::ranges::stable_sort(act.troubles, {}, &Trouble::at_ms);
    return act;
}

}  // namespace

const char *name_of(Upset upset) {
    static constexpr const char *NAMES[UPSET_COUNT] = {
        "pause", "step",   "leave", "override",      "odd command", "client gone", "abort",
        "off",   "e-stop", "chain", "changer fault", "reset",       "killed",      "power cut"};
    return NAMES[static_cast<int>(upset)];
}

const char *name_of(Work work) {
    static constexpr const char *NAMES[] = {"program", "from line", "MDI",   "switches", "by hand", "jog",
                                            "home",    "table",     "state", "odd",      "operate", "crash"};
    return NAMES[static_cast<int>(work)];
}

Plan make_plan(std::uint64_t seed) {
    plants::Random random(seed * 0x2545f4914f6cdd1dU + 15);
    Plan plan;
    plan.seed = seed;
    plan.isRandomChanger = random.chance(0.35);
    plan.changer_ms = random.whole(0, 60);
    const int tools = random.whole(3, 6);
    for (int i = 0; i < tools; ++i) {
        const bool isInSpindle = plan.isRandomChanger && i == 0;
        plan.tools.push_back({i + 1, isInSpindle ? 0 : 10 + i, random.whole(-6, 6) * 0.5});
    }
    World world;
    world.doings.tools = plan.tools;
    world.doings.isRandom = plan.isRandomChanger;
    const int acts = random.whole(4, 12);
    for (int i = 0; i < acts; ++i) {
        plan.acts.push_back(make_act(random, world));
    }
    return plan;
}

Plan reduced(const Plan &plan, const std::string &kept) {
    if (kept.empty()) {
        return plan;
    }
    Plan out = plan;
    out.acts.clear();
    for (const campaign_runner::Kept &one : campaign_runner::parse_kept(kept)) {
        if (one.act >= plan.acts.size()) {
            continue;
        }
        Act act = plan.acts[one.act];
        act.troubles.clear();
        act.blocks.clear();
        for (std::size_t i = 0; i < plan.acts[one.act].troubles.size(); ++i) {
            if (one.hasTrouble(i)) {
                act.troubles.push_back(plan.acts[one.act].troubles[i]);
            }
        }
        for (std::size_t i = 0; i < plan.acts[one.act].blocks.size(); ++i) {
            if (one.hasBlock(i)) {
                act.blocks.push_back(plan.acts[one.act].blocks[i]);
            }
        }
        out.acts.push_back(std::move(act));
    }
    return out;
}

}  // namespace mw::task_campaign
