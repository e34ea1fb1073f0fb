// SPDX-License-Identifier: GPL-2.0-or-later
#include "mesa_campaign/plan.hh"

#include <array>
#include <random>

#include <fmt/format.h>

#include "campaign_runner/kept.hh"

namespace mw::mesa_campaign {

namespace {

/// Loss rates of networks in which a machine can work, and in which it should not.
constexpr std::array LOSSES{0.0, 0.001, 0.01, 0.05};
constexpr double HARD_LOSS = 0.2;

class Dice {
  public:
    explicit Dice(unsigned seed) : random_(seed) {}
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
    double number(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    bool happens(double probability) { return std::bernoulli_distribution(probability)(random_); }

  private:
    std::mt19937 random_;
};

std::string direction(Dice &dice, const char *name, bool usable, std::int64_t &max_delay_ns) {
    const double loss =
        usable ? LOSSES[static_cast<std::size_t>(dice.whole(0, 3))] : dice.number(0, HARD_LOSS);
    std::string line = fmt::format("{} loss={:.4f}", name, loss);
    if (dice.happens(0.3)) {
        line += fmt::format(" duplicate={:.3f}", dice.number(0, 0.1));
    }
    if (dice.happens(0.3)) {
        line += fmt::format(" reorder={:.3f}", dice.number(0, usable ? 0.01 : 0.05));
        max_delay_ns += 700'000;
    }
    if (dice.happens(0.2)) {
        line += fmt::format(" cut={:.4f}", dice.number(0, 0.01));
    }
    if (dice.happens(0.3)) {
        const int most_us = usable ? 60 : 300;
        const int delay_us = dice.whole(0, most_us), jitter_us = dice.whole(0, most_us);
        line += fmt::format(" delay_us={} jitter_us={}", delay_us, jitter_us);
        max_delay_ns += 1000 * static_cast<std::int64_t>(delay_us + 6 * jitter_us);
    }
    if (!usable && dice.happens(0.5)) {
        const int late_us = dice.happens(0.5) ? 0 : dice.whole(200, 2000);
        line += fmt::format(" burst=0.001 burst_packets={} burst_delay_us={}", dice.whole(1, 50), late_us);
        max_delay_ns += 1000 * static_cast<std::int64_t>(late_us);
    }
    return line + "\n";
}

}  // namespace

Plan make_plan(unsigned seed) {
    Dice dice(seed);
    Plan plan{.seed = seed, .network = {}, .acts = {}};
    plan.network = fmt::format("seed {}\n", seed);
    plan.usable = dice.happens(0.75);
    plan.network += direction(dice, "to_board", plan.usable, plan.max_delay_ns);
    plan.network += direction(dice, "to_host", plan.usable, plan.max_delay_ns);
    plan.steps_per_mm = dice.number(20, 400);
    plan.speed = dice.number(5, 20'000 / plan.steps_per_mm);
    plan.accel = plan.speed * dice.number(2, 30);
    plan.max_accel = plan.accel * dice.number(1.2, 2.0);
    plan.watchdog_ms = dice.whole(3, 60);
    plan.reaction_ms = dice.whole(20, 1500);
    plan.arm_probability = dice.number(0, 0.05);
    const int acts = dice.whole(2, 6);
    for (int i = 0; i < acts; ++i) {
        Act act{.moving_cycles = dice.whole(500, 4000)};
        if (dice.happens(0.7)) {
            act.trouble = static_cast<Trouble>(dice.whole(1, 5));
            act.trouble_ms = dice.happens(0.5) ? dice.whole(1, 20) : dice.whole(20, 3000);
        }
        act.resting_cycles = dice.whole(0, 1000);
        plan.acts.push_back(act);
    }
    return plan;
}

Plan reduced(Plan plan, const std::string &kept) {
    if (kept.empty()) {
        return plan;
    }
    std::vector<Act> acts;
    for (const campaign_runner::Kept &one : campaign_runner::parse_kept(kept)) {
        if (one.act < plan.acts.size()) {
            Act act = plan.acts[one.act];
            act.trouble = one.hasTrouble(0) ? act.trouble : Trouble::NONE;
            acts.push_back(act);
        }
    }
    plan.acts = std::move(acts);
    return plan;
}

}  // namespace mw::mesa_campaign
