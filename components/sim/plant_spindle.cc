// SPDX-License-Identifier: GPL-2.0-or-later
// plant_spindle: a spindle with its drive, which ramps, reacts late and slips, and its encoder.
#include "components/plants/spindle_plant.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantSpindle {
    In<double> command_rps, load, ramp, lag_s, reaction_s, slip;
    In<bool> lose;
    In<std::int32_t> lose_counts;
    InOut<bool> index_enable;
    Out<double> revs, speed_rps, true_revs, true_speed_rps;
    ParamRw<std::int32_t> counts_per_turn;
    plants::SpindlePlant plant{{}};
    double last_revs = 0;
    bool isBegun = false, was_losing = false;

    void declare(Declare &d) noexcept {
        d.pin(command_rps, "command-rps");
        d.pin(load, "load");
        d.pin(ramp, "ramp");
        d.pin(lag_s, "lag-s");
        d.pin(reaction_s, "reaction-s");
        d.pin(slip, "slip");
        d.pin(lose, "lose");
        d.pin(lose_counts, "lose-counts");
        d.pin(index_enable, "index-enable");
        d.pin(revs, "revs");
        d.pin(speed_rps, "speed-rps");
        d.pin(true_revs, "true-revs");
        d.pin(true_speed_rps, "true-speed-rps");
        d.param(counts_per_turn, "counts-per-turn", 4096);
        d.function<&PlantSpindle::update>(this);
    }
    void update(long period_ns) noexcept {
        const double period_s = static_cast<double>(period_ns) * 1e-9;
        if (!isBegun) {
            isBegun = true;
            plants::SpindleTraits traits;
            traits.counts_per_turn = counts_per_turn > 0 ? static_cast<int>(counts_per_turn) : 1;
            plant = plants::SpindlePlant(traits);
        }
        plant.set_drive(ramp, lag_s, reaction_s, slip);
        if (lose && !was_losing) {
            plant.lose_counts(lose_counts);
        }
        was_losing = lose;
        plant.run(command_rps, load, period_s);
        speed_rps = (plant.shown_turns() - last_revs) / period_s;
        if (index_enable && plant.hasIndex()) {
            plant.zero_at_index();
            index_enable = false;
        }
        last_revs = plant.shown_turns();
        revs = last_revs;
        true_revs = plant.turns();
        true_speed_rps = plant.speed();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantSpindle, "plant_spindle", mw::sdk::MANY);
