// SPDX-License-Identifier: GPL-2.0-or-later
// timedelta: measures the regularity of a thread. All in nanoseconds, s32, since `reset` (bit) was true:
// `out` time since the previous run; `min`, `max` of it; `current-error` out minus the period,
// `current-jitter`
// its absolute value, `jitter` the maximum of those; `err` the sum of the errors, `avg-err` (float) their
// mean.
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Timedelta {
    Out<std::int32_t> jitter, current_jitter, current_error, min, max, out, err;
    Out<double> avg_err;
    In<bool> reset;
    long long last_ns = 0;
    std::int64_t sum = 0;
    std::int64_t runs = 0;
    bool first = true;

    void declare(Declare &d) noexcept {
        d.pin(jitter, "jitter");
        d.pin(current_jitter, "current-jitter");
        d.pin(current_error, "current-error");
        d.pin(min, "min");
        d.pin(max, "max");
        d.pin(reset, "reset");
        d.pin(out, "out");
        d.pin(err, "err");
        d.pin(avg_err, "avg-err");
        d.function<&Timedelta::update>(this);
    }

    void update(long period_ns) noexcept {
        const long long now_ns = rtapi_get_time();
        const std::int64_t delta = now_ns - last_ns;
        const bool was_first = first;
        last_ns = now_ns;
        first = false;
        if (was_first) {
            return;
        }
        const std::int64_t error = delta - period_ns;
        if (reset || runs == 0) {
            runs = 0;
            sum = 0;
            jitter = 0;
            min = as_pin(delta);
            max = as_pin(delta);
        }
        ++runs;
        sum += error;
        out = as_pin(delta);
        current_error = as_pin(error);
        current_jitter = as_pin(error < 0 ? -error : error);
        err = as_pin(sum);
        avg_err = static_cast<double>(sum) / static_cast<double>(runs);
        jitter = current_jitter > jitter ? current_jitter.get() : jitter.get();
        min = out < min ? out.get() : min.get();
        max = out > max ? out.get() : max.get();
    }

  private:
    static std::int32_t as_pin(std::int64_t ns) noexcept {
        const std::int64_t bounded = ns > 0x7fffffff ? 0x7fffffff : (ns < -0x7fffffff ? -0x7fffffff : ns);
        return static_cast<std::int32_t>(bounded);
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Timedelta, "timedelta", mw::sdk::MANY);
