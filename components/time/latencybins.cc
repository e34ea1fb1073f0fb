// SPDX-License-Identifier: GPL-2.0-or-later
// latencybins: a histogram of the latency of a thread, up to 1000 bins on each side.
// `latency` (s32) [ns] is the time since the previous run minus the period, counted in bins of `nsbinsize`
// (s32)
// [ns]. `index` (s32) selects a bin: `pbinvalue` is the count on the late side, `nbinvalue` on the early side
// (-1 if the bin does not exist; bin 0 is on the late side only), `check` repeats it. `maxbinnumber` (s32,
// 1000) bins
// are used; `pextra`, `nextra` count outside. latency-max, latency-min [ns], `variance` [ns^2],
// `availablebins` (1000). `reset` (bit) clears. With nsbinsize below 1 nothing is counted in bins.
#include <cmath>

#include "components/conv/conv_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

constexpr std::int32_t MAX_BIN = 1000;

struct Latencybins {
    In<std::int32_t> maxbinnumber, index;
    In<bool> reset;
    In<std::int32_t> nsbinsize;
    Out<std::int32_t> check, latency, latency_max, latency_min, pbinvalue, nbinvalue, pextra, nextra,
        variance;
    Out<std::int32_t> availablebins;

    std::int32_t late[MAX_BIN + 1] = {};
    std::int32_t early[MAX_BIN + 1] = {};
    long long last_ns = 0;
    double runs = 0.0;
    double mean = 0.0;
    double deviations = 0.0;
    bool first = true;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    void clear() noexcept;
    void count(std::int32_t ns) noexcept;
    std::int32_t last_bin() const noexcept {
        const std::int32_t wanted = maxbinnumber;
        return wanted < 0 ? 0 : (wanted > MAX_BIN ? MAX_BIN : wanted);
    }
};

void Latencybins::declare(Declare &d) noexcept {
    d.pin(maxbinnumber, "maxbinnumber", MAX_BIN);
    d.pin(index, "index");
    d.pin(reset, "reset");
    d.pin(nsbinsize, "nsbinsize");
    d.pin(check, "check");
    d.pin(latency, "latency");
    d.pin(latency_max, "latency-max");
    d.pin(latency_min, "latency-min");
    d.pin(pbinvalue, "pbinvalue");
    d.pin(nbinvalue, "nbinvalue");
    d.pin(pextra, "pextra");
    d.pin(nextra, "nextra");
    d.pin(variance, "variance");
    d.pin(availablebins, "availablebins", MAX_BIN);
    d.function<&Latencybins::update>(this);
}

void Latencybins::clear() noexcept {
    for (int i = 0; i <= MAX_BIN; ++i) {
        late[i] = 0;
        early[i] = 0;
    }
    runs = mean = deviations = 0.0;
    latency_max = 0;
    latency_min = 0;
    pextra = 0;
    nextra = 0;
    variance = 0;
}

void Latencybins::count(std::int32_t ns) noexcept {
    latency_max = ns > latency_max ? ns : latency_max.get();
    latency_min = ns < latency_min ? ns : latency_min.get();
    runs += 1.0;
    const double before = mean;
    mean += (ns - before) / runs;
    deviations += (ns - before) * (ns - mean);
    variance = conv::convert<std::int32_t>(runs > 1.0 ? deviations / (runs - 1.0) : 0.0, true).value;
    const std::int32_t size = nsbinsize;
    if (size < 1) {
        return;
    }
    const bool is_late = ns >= 0 || -static_cast<std::int64_t>(ns) < size;
    const std::int64_t bin = (ns < 0 ? -static_cast<std::int64_t>(ns) : ns) / size;
    if (bin <= last_bin()) {
        ++(is_late ? late : early)[bin];
    } else if (is_late) {
        pextra = next_count(pextra);
    } else {
        nextra = next_count(nextra);
    }
}

void Latencybins::update(long period_ns) noexcept {
    const long long now_ns = rtapi_get_time();
    const long long late_ns = now_ns - last_ns - period_ns;
    const bool was_first = first;
    last_ns = now_ns;
    first = false;
    if (reset) {
        clear();
    } else if (!was_first) {
        latency = conv::convert<std::int32_t>(static_cast<std::int64_t>(late_ns), true).value;
        count(latency);
    }
    const std::int32_t wanted = index;
    const bool is_bin = wanted >= 0 && wanted <= last_bin();
    pbinvalue = is_bin ? late[wanted] : -1;
    nbinvalue = is_bin ? early[wanted] : -1;
    check = wanted;
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Latencybins, "latencybins", mw::sdk::MANY);
