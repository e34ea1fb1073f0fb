// SPDX-License-Identifier: GPL-2.0-or-later
#include "campaign/plan.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <fmt/format.h>

namespace mw::campaign {
namespace {

double to_grid(double x) {
    return std::round(x * 1e4) / 1e4;
}

/// Writes programs whose path it knows.
class Writer {
  public:
    Writer(sim::Random &random, const Design &design) : random_(random), design_(design) {}

    std::vector<Block> write(double seconds) {
        say("G21 G90 G17 G94 G80 G40");
        set_mode();
        move_to_start();
        if (random_.chance(0.3)) {
            spindle();
        }
        double expected = 0;
        const int most = random_.whole(8, 60);
        for (int n = 0; n < most && expected < seconds; ++n) {
            if (random_.chance(0.06)) {
                set_mode();
            }
            if (random_.chance(0.08)) {
                output();
            }
            expected += random_.chance(0.3) && hasAxis(geom::AXIS_Y) ? arc() : line();
        }
        say("M63 P0");
        say("M2");
        return std::move(blocks_);
    }

  private:
    bool hasAxis(int axis) const {
        return std::ranges::any_of(design_.axes, [&](const AxisDesign &a) { return a.axis == axis; });
    }
    const AxisDesign &axis(int letter) const {
        return *std::ranges::find_if(design_.axes, [&](const AxisDesign &a) { return a.axis == letter; });
    }
    void say(const std::string &text) {
        Block b;
        b.text = text;
        blocks_.push_back(b);
    }
    void set_mode() {
        const int kind = random_.whole(0, 9);
        settings_.mode = kind == 0   ? geom::PathMode::EXACT_STOP
                         : kind == 1 ? geom::PathMode::EXACT_PATH
                                     : geom::PathMode::BLEND;
        settings_.tolerance = to_grid(std::pow(10.0, random_.real(-1.5, -0.2)));
        settings_.naivecam_tolerance = 0;
        if (kind > 1) {
            say(fmt::format("G64 P{:.4f}", settings_.tolerance));
        } else {
            say(kind == 0 ? "G61.1" : "G61");
            settings_.tolerance = 0;
        }
    }
    void spindle() {
        Block b;
        b.text = fmt::format("M3 S{}", random_.whole(100, 3000));
        blocks_.push_back(b);
        b.text = "G4 P0.6";
        b.dwell_s = 0.6;
        blocks_.push_back(b);
    }
    void output() {
        say(random_.chance(0.5) ? "M62 P0" : "M63 P0");
        if (random_.chance(0.2)) {
            Block b;
            b.text = fmt::format("M64 P{}", random_.whole(1, 2));
            b.isTimed = false;  // motion comes to a stop
            blocks_.push_back(b);
        }
    }
    /// Within the soft limits, with some room for the joints of other kinematics.
    double place(const AxisDesign &a) { return to_grid(random_.real(0.9 * a.low, 0.9 * a.high)); }
    void move_to_start() {
        std::string text = "G0";
        for (const AxisDesign &a : design_.axes) {
            at_[a.axis] = to_grid(0.5 * place(a));
            text += fmt::format(" {}{:.4f}", geom::AXIS_LETTERS[a.axis], at_[a.axis]);
        }
        push(text, true);
    }
    void push(const std::string &text, bool isRapid) {
        Block b;
        b.text = text;
        b.isMove = true;
        b.end = at_;
        b.settings = settings_;
        b.settings.isRapid = isRapid;
        b.settings.feed = isRapid ? 0 : feed_ / 60;
        blocks_.push_back(b);
    }
    std::string feed_word() {
        feed_ = std::round(std::pow(10.0, random_.real(2.3, 4.1)));
        return fmt::format(" F{:.0f}", feed_);
    }
    /// The time that it takes at its feed.
    double line() {
        const geom::Pose from = at_;
        const double size = std::pow(10.0, random_.real(-1, 0));
        std::string words;
        for (const AxisDesign &a : design_.axes) {
            if (random_.chance(0.6)) {
                at_[a.axis] = to_grid(at_[a.axis] + size * (place(a) - at_[a.axis]));
                words += fmt::format(" {}{:.4f}", geom::AXIS_LETTERS[a.axis], at_[a.axis]);
            }
        }
        if (words.empty()) {
            return 0;
        }
        const bool isRapid = random_.chance(0.2);
        push((isRapid ? "G0" : "G1") + words + (isRapid ? std::string() : feed_word()), isRapid);
        const geom::Pose way = at_ - from;
        double length = geom::norm_linear(way);
        length = length > 0 ? length : geom::norm_abc(way);
        return isRapid ? length / design_.velocity : length / (feed_ / 60);
    }
    double arc() {
        const AxisDesign &x = axis(geom::AXIS_X);
        const AxisDesign &y = axis(geom::AXIS_Y);
        const double room =
            0.9 * std::min({x.high - at_[0], at_[0] - x.low, y.high - at_[1], at_[1] - y.low});
        if (room < 1) {
            return 0;
        }
        const double radius = 0.5 * room * std::pow(10.0, random_.real(-1.5, 0));
        const double phase = random_.real(0, 2 * std::numbers::pi);
        const double i = to_grid(-radius * std::cos(phase));
        const double j = to_grid(-radius * std::sin(phase));
        const bool isLeft = random_.chance(0.5);
        const double angle = random_.real(0.2, 5.8) * (isLeft ? 1 : -1);
        const double from = std::atan2(-j, -i);
        geom::Pose centre = at_;
        centre[0] = at_[0] + i;
        centre[1] = at_[1] + j;
        const double r = std::hypot(i, j);
        const geom::Pose start = at_;
        at_[0] = to_grid(centre[0] + r * std::cos(from + angle));
        at_[1] = to_grid(centre[1] + r * std::sin(from + angle));
        std::string text = fmt::format("G{} X{:.4f} Y{:.4f}", isLeft ? 3 : 2, at_[0], at_[1]);
        if (random_.chance(0.3)) {
            const AxisDesign &z = axis(geom::AXIS_Z);
            at_[2] = to_grid(at_[2] + 0.2 * (place(z) - at_[2]));
            text += fmt::format(" Z{:.4f}", at_[2]);
        }
        push(text + fmt::format(" I{:.4f} J{:.4f}", i, j) + feed_word(), false);
        Block &b = blocks_.back();
        b.isArc = true;
        b.centre = centre;
        // As the rounded end says.
        const double to = std::atan2(at_[1] - centre[1], at_[0] - centre[0]);
        const double turn = 2 * std::numbers::pi;
        double swept = std::remainder(to - from - angle, turn) + angle;
        b.angle_rad = swept;
        return std::hypot(r * angle, at_[2] - start[2]) / (feed_ / 60);
    }

    sim::Random &random_;
    const Design &design_;
    std::vector<Block> blocks_;
    geom::MoveSettings settings_;
    geom::Pose at_;
    double feed_ = 1000;
};

/// A twin of a gantry is not moved alone.
bool isAlone(const Design &design, int joint) {
    return design.joints[static_cast<std::size_t>(joint)].sequence >= 0;
}

Act make_jog(sim::Random &random, const Design &design) {
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

Trouble make_trouble(sim::Random &random, const Design &design, bool isPassingWanted, int span_ms) {
    Trouble t;
    const int first_passing = static_cast<int>(Upset::PAUSE);
    t.what = static_cast<Upset>(isPassingWanted      ? random.whole(first_passing, UPSET_COUNT - 1)
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

}  // namespace

const char *name_of(Upset upset) {
    static constexpr const char *NAMES[UPSET_COUNT] = {
        "abort",        "off",          "e-stop command", "e-stop",       "enable off",    "amp fault",
        "limit switch", "encoder lost", "encoder jump",   "encoder NaN",  "spindle fault", "probe stuck",
        "task hung",    "task dead",    "pause",          "spindle NaN",  "feed override", "rapid override",
        "feed inhibit", "adaptive NaN", "planner late",   "planner lost", "wrong commands"};
    return NAMES[static_cast<int>(upset)];
}

Plan make_plan(std::uint64_t seed) {
    Plan plan;
    plan.seed = seed;
    sim::Random random(seed * 0x2545f4914f6cdd1dU + 1);
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

namespace {

/// ".0.2": the troubles 0 and 2; "x": none. Moves on to what follows.
void keep_troubles(const char *&at, Act &act) {
    if (*at == 'x') {
        act.troubles.clear();
        ++at;
    }
    if (*at != '.') {
        return;
    }
    std::vector<Trouble> troubles;
    while (*at == '.') {
        char *end = nullptr;
        const auto n = std::strtoul(at + 1, &end, 10);
        at = end;
        if (n < act.troubles.size()) {
            troubles.push_back(act.troubles[n]);
        }
    }
    act.troubles = std::move(troubles);
}

/// ":3-9": the moves among the blocks 3 to 9, and all that is no move.
void keep_blocks(const char *at, Act &act) {
    if (*at != ':') {
        return;
    }
    char *dash = nullptr;
    const auto from = std::strtoul(at + 1, &dash, 10);
    const auto to = *dash == '-' ? std::strtoul(dash + 1, nullptr, 10) : from;
    std::vector<Block> blocks;
    for (std::size_t i = 0; i < act.blocks.size(); ++i) {
        if (!act.blocks[i].isMove || (i >= from && i <= to)) {
            blocks.push_back(act.blocks[i]);
        }
    }
    act.blocks = std::move(blocks);
}

}  // namespace

Plan reduced(const Plan &plan, const std::string &kept) {
    if (kept.empty()) {
        return plan;
    }
    Plan out = plan;
    out.acts.clear();
    std::istringstream in(kept);
    for (std::string word; std::getline(in, word, ',');) {
        char *end = nullptr;
        const auto number = static_cast<std::size_t>(std::strtoul(word.c_str(), &end, 10));
        if (number < plan.acts.size()) {
            Act act = plan.acts[number];
            const char *at = end;
            keep_troubles(at, act);
            keep_blocks(at, act);
            out.acts.push_back(std::move(act));
        }
    }
    return out;
}

}  // namespace mw::campaign
