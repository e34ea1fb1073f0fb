// SPDX-License-Identifier: GPL-2.0-or-later
// histobins: a histogram of a pin, up to 200 bins.
// In each period the input that `pintype` (u32: 0 input, float; 1 input-s32; 2 input-u32; 3 input-bit)
// selects
// is counted in one of `nbins` (u32, 20) bins of width `binsize` (float, 1) starting at `minvalue` (float,
// 0), or
// in `nextra` or `pextra` (float) below or above. `index` (s32) selects the bin whose count is `binvalue`
// (float, -1 for none); `check` (s32) repeats it. Also input-min, input-max, nsamples (u32), mean and
// variance (float; the update of B. P. Welford, or from sums of squares while `method` (bit) is true).
// `reset` (bit) clears. `input-error` (bit): nbins above `availablebins` (s32, 200) or below 1, binsize not
// above 0, or an invalid pintype; nothing is counted then. A change of nbins, binsize or minvalue also
// clears.
#include <cmath>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

constexpr std::int32_t MAX_BINS = 200;

struct Histobins {
    In<std::uint32_t> pintype;
    In<double> input;
    In<std::int32_t> input_s32;
    In<std::uint32_t> input_u32;
    In<bool> input_bit;
    In<std::uint32_t> nbins;
    In<double> binsize, minvalue;
    In<std::int32_t> index;
    Out<std::int32_t> check;
    In<bool> reset, method;
    Out<bool> input_error;
    Out<double> binvalue, pextra, nextra, input_min, input_max;
    Out<std::uint32_t> nsamples;
    Out<double> variance, mean;
    Out<std::int32_t> availablebins;

    std::uint32_t bins[MAX_BINS] = {};
    std::uint32_t used_bins = 0;
    double used_size = 0.0;
    double used_min = 0.0;
    double deviations = 0.0;  // sum of the squared differences from the average
    double sum = 0.0;
    double squares = 0.0;

    void declare(Declare &d) noexcept;
    void update() noexcept;

  private:
    bool isValid() const noexcept { return nbins >= 1 && nbins <= MAX_BINS && binsize > 0.0 && pintype <= 3; }
    double chosen() const noexcept;
    void clear() noexcept;
    void count(double value) noexcept;
};

void Histobins::declare(Declare &d) noexcept {
    d.pin(pintype, "pintype");
    d.pin(input, "input");
    d.pin(input_s32, "input-s32");
    d.pin(input_u32, "input-u32");
    d.pin(input_bit, "input-bit");
    d.pin(nbins, "nbins", 20U);
    d.pin(binsize, "binsize", 1.0);
    d.pin(minvalue, "minvalue");
    d.pin(index, "index");
    d.pin(check, "check");
    d.pin(reset, "reset");
    d.pin(method, "method");
    d.pin(input_error, "input-error");
    d.pin(binvalue, "binvalue");
    d.pin(pextra, "pextra");
    d.pin(nextra, "nextra");
    d.pin(input_min, "input-min");
    d.pin(input_max, "input-max");
    d.pin(nsamples, "nsamples");
    d.pin(variance, "variance");
    d.pin(mean, "mean");
    d.pin(availablebins, "availablebins", MAX_BINS);
    d.function<&Histobins::update>(this);
}

double Histobins::chosen() const noexcept {
    switch (pintype) {
    case 1: return input_s32;
    case 2: return input_u32;
    case 3: return input_bit ? 1.0 : 0.0;
    default: return input;
    }
}

void Histobins::clear() noexcept {
    for (std::uint32_t &bin : bins) {
        bin = 0;
    }
    used_bins = nbins;
    used_size = binsize;
    used_min = minvalue;
    deviations = sum = squares = 0.0;
    pextra = 0.0;
    nextra = 0.0;
    nsamples = 0;
    mean = 0.0;
    variance = 0.0;
}

void Histobins::count(double value) noexcept {
    const double place = (value - used_min) / used_size;
    if (place < 0.0) {
        nextra = nextra + 1.0;
    } else if (place >= used_bins) {
        pextra = pextra + 1.0;
    } else {
        ++bins[static_cast<int>(place)];
    }
    const bool first = nsamples == 0;
    input_min = first || value < input_min ? value : input_min.get();
    input_max = first || value > input_max ? value : input_max.get();
    nsamples = nsamples + 1;
    const double n = nsamples;
    const double before = mean;
    mean = before + (value - before) / n;
    deviations += (value - before) * (value - mean);
    sum += value;
    squares += value * value;
    const double total = method ? squares - sum * sum / n : deviations;
    variance = n > 1.0 ? total / (n - 1.0) : 0.0;
}

void Histobins::update() noexcept {
    input_error = !isValid();
    if (!isValid()) {
        return;
    }
    if (reset || nbins != used_bins || binsize != used_size || minvalue != used_min) {
        clear();
    }
    const double value = chosen();
    if (!reset && std::isfinite(value)) {
        count(value);
    }
    const std::int32_t wanted = index;
    const bool is_bin = wanted >= 0 && wanted < static_cast<std::int32_t>(used_bins);
    binvalue = is_bin ? bins[wanted] : -1.0;
    check = wanted;
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Histobins, "histobins", mw::sdk::MANY);
