// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/plan.hh"

#include <algorithm>
#include <cmath>

#include "campaign/program_writer.hh"

namespace mw::campaign {
namespace {

/// The second joint of a gantry is not moved alone.
bool isAlone(const Design &design, int joint) {
    return design.joints[static_cast<std::size_t>(joint)].sequence >= 0;
}

Act make_jog(plants::Random &random, const Design &design) {
    Act act;
    act.work = random.chance(0.5) ? Work::JOG_JOINT : Work::JOG_AXIS;
    double most = 0;
    double range = 0;
    if (act.work == Work::JOG_JOINT) {
        do {
            act.target = random.whole(0, static_cast<int>(design.joints.size()) - 1);
        } while (!isAlone(design, act.target));
        const JointDesign &j = design.joints[static_cast<std::size_t>(act.target)];
        most = j.velocity;
        range = j.high - j.low;
    } else {
        const AxisDesign &a =
            design.axes[static_cast<std::size_t>(random.whole(0, static_cast<int>(design.axes.size()) - 1))];
        act.target = a.axis;
        most = a.velocity;
        range = a.high - a.low;
    }
    const double sign = random.chance(0.5) ? 1 : -1;
    act.velocity = most * random.real(0.1, 1.3);
    act.distance = random.chance(0.5) ? sign * range * random.real(0.001, 0.3) : 0;
    act.velocity *= act.distance == 0 ? sign : 1;
    act.length_ms = random.whole(50, 1500);
    return act;
}

/// Replaces a jog by command with a jog by wheel over the same distance.
void turn_wheel(plants::Random &random, Act &act) {
    Turning &t = act.turning;
    t.isJoint = act.work == Work::JOG_JOINT;
    t.scale = std::round(std::pow(10.0, random.real(-3, 0)) * 1e4) / 1e4;
    t.counts_per_cycle = random.whole(1, 4) * (random.chance(0.5) ? 1 : -1);
    t.pause = random.whole(1, 30);
    t.cycles = random.whole(20, 800);
    t.isVelocityMode = random.chance(0.4);
    t.accel_fraction = random.chance(0.7) ? 1 : random.real(0.1, 1);
    act.work = Work::WHEEL;
}

Trouble make_trouble(plants::Random &random, const Design &design, bool isPassingWanted, int span_ms,
                     Upset last = Upset::WRONG_COMMANDS) {
    Trouble t;
    const int first_passing = static_cast<int>(Upset::PAUSE);
    t.what = static_cast<Upset>(isPassingWanted      ? random.whole(first_passing, static_cast<int>(last))
                                : random.chance(0.4) ? 0
                                                     : random.whole(0, first_passing - 1));
    if (t.what == Upset::TASK_DEAD && random.chance(0.7)) {
        t.what = Upset::ABORT;  // it ends the session
    }
    t.at_ms = random.whole(0, span_ms);
    t.length_ms = t.what == Upset::PLANNER_LATE   ? random.whole(5, 40)
                  : t.what == Upset::PLANNER_LOST ? random.whole(200, 1000)
                  : t.what == Upset::TASK_HUNG    ? random.whole(520, 900)
                                                  : random.whole(20, 400);
    t.joint = random.whole(0, static_cast<int>(design.joints.size()) - 1);
    t.value = random.real(0, 1);
    return t;
}

/// Sessions of about a minute, as in the first plan.
Plan make_long_plan(std::uint64_t seed) {
    Plan plan;
    plants::Random random(seed * 0x2545f4914f6cdd1dU + 1);
    plan.design = make_design(random);
    const int acts = random.whole(6, 10);
    int troubles = 0;
    for (int n = 0; n < acts || troubles < 2; ++n) {
        Act act;
        const double kind = random.real(0, 1);
        if (n == 0 || kind < 0.65) {
            const double seconds = random.real(1.5, 4);
            act.blocks = Writer(random, plan.design).write(seconds);
        } else if (kind < 0.92) {
            act = make_jog(random, plan.design);
        } else {
            act.work = Work::HOME;
        }
        const int span_ms = act.work == Work::PROGRAM ? 3000 : 1200;
        while (n > 0 && random.chance(0.4)) {
            act.troubles.push_back(make_trouble(random, plan.design, true, span_ms));
        }
        if (n > 0 && random.chance(0.6)) {
            act.troubles.push_back(make_trouble(random, plan.design, false, span_ms));
            ++troubles;
        }
        std::ranges::sort(act.troubles, {}, &Trouble::at_ms);
        plan.acts.push_back(std::move(act));
    }
    return plan;
}

Act make_act(plants::Random &random, const Design &design, unsigned version) {
    Act act;
    const double kind = random.real(0, 1);
    if (kind < 0.5) {
        Writer writer(random, design);
        act.isTimed = !writer.allow_waits();
        act.blocks = writer.write(random.real(0.5, 2));
    } else if (kind < 0.6 && design.isTrivial) {
        act = Writer(random, design).write_probing();
    } else if (kind < 0.72 && (design.isTrivial || version > 3)) {
        act = Writer(random, design).write_in_step();
    } else if (kind < 0.9) {
        act = make_jog(random, design);
        if (design.name == "delta" || design.isFurther) {
            // Legs that are far apart leave the travel of the axes.
            act.work = Work::JOG_AXIS;
            const int last = design.isFurther ? static_cast<int>(design.axes.size()) - 1 : 2;
            act.target = design.axes[static_cast<std::size_t>(random.whole(0, last))].axis;
        }
        if (random.chance(0.3)) {
            turn_wheel(random, act);
        } else if (act.distance == 0 && random.chance(0.4)) {
            act.lease_ms = random.whole(30, 400);
        }
    } else {
        act.work = Work::HOME;
    }
    return act;
}

void make_troubles(plants::Random &random, const Design &design, Act &act) {
    const int span_ms = isProgram(act.work) ? 2000 : 900;
    while (random.chance(0.35)) {
        act.troubles.push_back(make_trouble(random, design, true, span_ms, Upset::SPINDLE_OVERRIDE));
    }
    if (design.hasOffsets() && random.chance(0.4)) {
        act.troubles.push_back(make_trouble(random, design, true, span_ms));
        act.troubles.back().what = Upset::OFFSET;
    }
    if (random.chance(0.7)) {
        act.troubles.push_back(make_trouble(random, design, false, span_ms));
        // No act can follow the death of task, so task may die only in the last act.
        Trouble &last = act.troubles.back();
        last.what = last.what == Upset::TASK_DEAD ? Upset::ABORT : last.what;
    }
    for (Trouble &t : act.troubles) {
        // A synchronized motion needs the measured speed.
        t.what = t.what == Upset::SPINDLE_NAN && act.work == Work::SPINDLE ? Upset::PAUSE : t.what;
    }
    std::ranges::sort(act.troubles, {}, &Trouble::at_ms);
}

/// Sessions of 11 to 25 s.
Plan make_short_plan(std::uint64_t seed, unsigned version) {
    constexpr int MOST_ACTS = 24;
    Plan plan;
    plants::Random random(seed * 0x2545f4914f6cdd1dU + (version > 3 ? version : 2));
    const bool isFurther = version > 3 && random.chance(0.6);
    const bool isOther = random.chance(version > 3 ? 0.3 : 0.12);
    plan.design = isFurther ? make_further_design(random)
                  : isOther ? make_other_design(random)
                            : make_design(random);
    plan.design.isFurther = isFurther;
    shorten(random, plan.design);
    wear(random, plan.design);
    equip_spindle(random, plan.design);
    allow_offsets(random, plan.design);
    plan.least_s = random.real(10.5, 14);
    for (int n = 0; n < MOST_ACTS; ++n) {
        Act act = make_act(random, plan.design, version);
        if (n > 0) {
            make_troubles(random, plan.design, act);
        }
        plan.acts.push_back(std::move(act));
    }
    if (random.chance(0.05)) {
        Trouble t = make_trouble(random, plan.design, false, 1000);
        t.what = Upset::TASK_DEAD;
        plan.acts.back().troubles = {t};
    }
    return plan;
}

}  // namespace

const char *name_of(Upset upset) {
    static constexpr const char *NAMES[UPSET_COUNT] = {
        "abort",           "off",           "e-stop command", "e-stop",          "enable off",
        "amp fault",       "limit switch",  "encoder lost",   "encoder jump",    "encoder NaN",
        "spindle fault",   "probe stuck",   "task hung",      "task dead",       "pause",
        "spindle NaN",     "feed override", "rapid override", "feed inhibit",    "adaptive NaN",
        "planner late",    "planner lost",  "wrong commands", "external offset", "adaptive feed",
        "spindle override"};
    return NAMES[static_cast<int>(upset)];
}

bool hasTrouble(const Act &act, Upset what) {
    return std::ranges::any_of(act.troubles, [what](const Trouble &t) { return t.what == what; });
}

namespace {

Plan without_planner_at_stops(Plan plan) {
    constexpr int AWAY_MS = 700;
    for (Act &act : plan.acts) {
        std::vector<Trouble> all;
        for (const Trouble &t : act.troubles) {
            if (!isPassing(t.what)) {
                all.push_back({Upset::PLANNER_LOST, t.at_ms, AWAY_MS, t.joint, 0});
            }
            all.push_back(t);
        }
        act.troubles = std::move(all);
    }
    return plan;
}

}  // namespace

Plan make_plan(std::uint64_t seed, unsigned version) {
    if (version == PLANNER_LOST_PLAN) {
        return without_planner_at_stops(make_plan(seed));
    }
    Plan plan = version == 1 ? make_long_plan(seed) : make_short_plan(seed, version);
    plan.seed = seed;
    return plan;
}

}  // namespace mw::campaign
