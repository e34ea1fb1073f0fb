// SPDX-License-Identifier: GPL-2.0-or-later
// anglejog: jogs two axes along a line at an angle with one wheel.
// While `enable-in` (bit) is true each count of `counts-in` (s32) moves a point on the line by the scale,
// with at most `max-vel` and `max-accel`; `coscounts` and `sincounts` (s32) are its coordinates in units of
// `current-scale-out`, which is the scale divided by `iscale-factor` (s32, 10000 at start).
// `angle-degrees-in`, `scale-in` and iscale-factor are read only while enable-in is false and at the start;
// the active values are `current-angle-degrees`, `current-scale`. Others: enable-out, active (bit);
// current-mag, current-vel; cos-accel-fraction, sin-accel-fraction: the parts of `accel-fraction-in` (1).
// Other pins are float.
#include <cmath>
#include <numbers>

#include "components/conv/conv_core.hh"
#include "components/machine/follower.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Anglejog {
    In<bool> enable_in;
    In<std::int32_t> counts_in, iscale_factor;
    In<double> angle_degrees_in, scale_in, max_vel, max_accel, accel_fraction_in;
    Out<bool> enable_out, active;
    Out<double> current_scale, current_scale_out, cos_fraction, sin_fraction;
    Out<std::int32_t> coscounts, sincounts;
    Out<double> current_angle_degrees, current_mag, current_vel;
    Follower follower;
    double target = 0.0;
    double cosine = 1.0;
    double sine = 0.0;
    std::int32_t last_counts = 0;
    bool first = true;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    void take_settings() noexcept;
};

void Anglejog::declare(Declare &d) noexcept {
    d.pin(enable_in, "enable-in");
    d.pin(counts_in, "counts-in");
    d.pin(angle_degrees_in, "angle-degrees-in");
    d.pin(iscale_factor, "iscale-factor", 10000);
    d.pin(scale_in, "scale-in");
    d.pin(max_vel, "max-vel");
    d.pin(max_accel, "max-accel");
    d.pin(accel_fraction_in, "accel-fraction-in", 1.0);
    d.pin(enable_out, "enable-out");
    d.pin(current_scale, "current-scale");
    d.pin(current_scale_out, "current-scale-out");
    d.pin(coscounts, "coscounts");
    d.pin(sincounts, "sincounts");
    d.pin(cos_fraction, "cos-accel-fraction");
    d.pin(sin_fraction, "sin-accel-fraction");
    d.pin(active, "active");
    d.pin(current_angle_degrees, "current-angle-degrees");
    d.pin(current_mag, "current-mag");
    d.pin(current_vel, "current-vel");
    d.function<&Anglejog::update>(this);
}

void Anglejog::take_settings() noexcept {
    const double angle = angle_degrees_in;
    const double scale = scale_in;
    const std::int32_t factor = iscale_factor;
    if (std::isfinite(angle)) {
        current_angle_degrees = angle;
    }
    if (std::isfinite(scale)) {
        current_scale = scale;
    }
    current_scale_out = current_scale / (factor > 1 ? factor : 1);
    const double radians = current_angle_degrees * std::numbers::pi / 180.0;
    cosine = std::cos(radians);
    sine = std::sin(radians);
}

void Anglejog::update(long period_ns) noexcept {
    const double dt = seconds(period_ns);
    const bool enabled = enable_in;
    const std::int32_t counts = counts_in;
    // Subtracted as unsigned, so that a wrap of the counter is one step.
    const auto turned = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts) -
                                                  static_cast<std::uint32_t>(last_counts));
    last_counts = counts;
    if (first || !enabled) {
        take_settings();
    }
    const bool is_start = first;
    first = false;
    enable_out = enabled;
    if (enabled) {
        target += is_start ? 0.0 : turned * current_scale;
        follower.run(target, max_vel, max_accel, dt);
    } else {
        follower.stop(max_accel, dt);
        target = follower.planner.target;
    }
    const double fraction = accel_fraction_in;
    cos_fraction = fraction * std::fabs(cosine);
    sin_fraction = fraction * std::fabs(sine);
    const double unit = current_scale_out;
    const double length = unit != 0.0 ? follower.position() / unit : 0.0;
    coscounts = conv::convert<std::int32_t>(length * cosine, true).value;
    sincounts = conv::convert<std::int32_t>(length * sine, true).value;
    active = follower.isMoving();
    current_mag = follower.position();
    current_vel = follower.velocity();
}

}  // namespace mw::components

MW_COMPONENT(mw::components::Anglejog, "anglejog", mw::sdk::MANY);
