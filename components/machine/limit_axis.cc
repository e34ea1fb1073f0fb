// SPDX-License-Identifier: GPL-2.0-or-later
// limit_axis: limits of one axis that depend on the position of another. `personality=` gives the number of
// ranges, 1 to 10 (default 2).
//
// `fb` is the position that chooses; range NN is the first one with `enable-NN` (bit, true at start) for
// which `fb` is between `min-range-NN` and `max-range-NN`, both included. `min-output` and `max-output` are
// then `min-limit-NN` and `max-limit-NN`, and `current-range` (u32) is NN. With `sticky-NN` (bit) the range
// is kept while fb is in it, even when an earlier range matches too. When no range matches, or fb is not a
// number, `error-no-range` (bit) is true and the limits do not change; neither do they when the limits of the
// range are invalid (max below min). All other pins are float.
#include "hal/sdk/component.hh"

MW_PERSONALITY("ranges of each instance");

namespace mw::components {
using namespace sdk;

struct AxisRange {
    In<double> min_limit, max_limit, min_range, max_range;
    In<bool> enable, sticky;
};

struct LimitAxis {
    static constexpr int MAX_RANGES = 10;
    int ranges = 0;
    Out<bool> error_no_range;
    Out<double> min_output, max_output;
    In<double> fb;
    Out<std::uint32_t> current_range;
    AxisRange range[MAX_RANGES];
    int chosen = -1;

    void declare(Declare &d) noexcept {
        ranges = d.personality_number(personality[d.index()], 2, MAX_RANGES, "ranges");
        d.pin(error_no_range, "error-no-range");
        d.pin(min_output, "min-output");
        d.pin(max_output, "max-output");
        d.pin(fb, "fb");
        d.pin(current_range, "current-range");
        for (int i = 0; i < ranges; ++i) {
            d.pin_at(range[i].min_limit, "min-limit-%02d", i);
            d.pin_at(range[i].max_limit, "max-limit-%02d", i);
            d.pin_at(range[i].min_range, "min-range-%02d", i);
            d.pin_at(range[i].max_range, "max-range-%02d", i);
            d.pin_at(range[i].enable, "enable-%02d", i, true);
            d.pin_at(range[i].sticky, "sticky-%02d", i);
        }
        d.function<&LimitAxis::update>(this);
    }

    void update() noexcept {
        const double position = fb;
        int match = -1;
        if (chosen >= 0 && range[chosen].sticky && isIn(range[chosen], position)) {
            match = chosen;
        }
        for (int i = 0; i < ranges && match < 0; ++i) {
            match = isIn(range[i], position) ? i : -1;
        }
        const bool usable = match >= 0 && range[match].min_limit <= range[match].max_limit;
        error_no_range = !usable;
        if (usable) {
            chosen = match;
            current_range = static_cast<std::uint32_t>(match);
            min_output = range[match].min_limit.get();
            max_output = range[match].max_limit.get();
        }
    }

  private:
    static bool isIn(const AxisRange &tested, double position) noexcept {
        return tested.enable && tested.min_range <= position && position <= tested.max_range;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::LimitAxis, "limit_axis", mw::sdk::MANY);
