// SPDX-License-Identifier: GPL-2.0-or-later
// eoffset_per_angle: an external offset as a function of an angle, such as a polygon on a lathe.
//
// `kcounts` (s32) is the offset times `k` (u32, 10000 at start and for 0), `kreciprocal` 1 / k. With the
// radius R = `radius-ref` (1), F = `rfraction` (0.1) and the angle x = `angle` - `start-angle` [degrees],
// `fnum` (s32) chooses: 0 the distance of a polygon of `fmult` (6, at least 3) sides around the circle
// (1+F)R, less R; 1 the same for the polygon inside that circle; 2 a sinus from 0 to FR, fmult times per
// revolution; 3 the same as a square wave. Other numbers count as 0. `is-on` and `enable-in` (bit) start it,
// is-on false stops it at once; else `enable-out` stays true until `active` (bit) shows that the offset is
// removed. `clear`, `is-off` (bit), `eoffset-dbg`, `state-dbg` (u32).
#include <cmath>
#include <numbers>

#include "components/conv/conv_core.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

enum EoffsetState : std::uint32_t { EOFFSET_OFF, EOFFSET_READY, EOFFSET_ON, EOFFSET_RETURNING, EOFFSET_DONE };

struct EoffsetPerAngle {
    In<bool> active, is_on, enable_in;
    In<double> radius_ref, angle, start_angle, rfraction, fmult;
    In<std::int32_t> fnum;
    In<std::uint32_t> k;
    Out<bool> is_off, enable_out, clear;
    Out<std::int32_t> kcounts;
    Out<double> kreciprocal, eoffset_dbg;
    Out<std::uint32_t> state_dbg;
    EoffsetState state = EOFFSET_OFF;

    void declare(Declare &d) noexcept;
    void update() noexcept;

  private:
    bool compute(double &offset) const noexcept;
    EoffsetState next_state(bool computed) const noexcept;
};

void EoffsetPerAngle::declare(Declare &d) noexcept {
    d.pin(active, "active");
    d.pin(is_on, "is-on");
    d.pin(enable_in, "enable-in");
    d.pin(radius_ref, "radius-ref", 1.0);
    d.pin(angle, "angle");
    d.pin(start_angle, "start-angle");
    d.pin(fnum, "fnum");
    d.pin(rfraction, "rfraction", 0.1);
    d.pin(fmult, "fmult", 6.0);
    d.pin(k, "k", 10000U);
    d.pin(is_off, "is-off");
    d.pin(enable_out, "enable-out");
    d.pin(clear, "clear");
    d.pin(kcounts, "kcounts");
    d.pin(kreciprocal, "kreciprocal");
    d.pin(eoffset_dbg, "eoffset-dbg");
    d.pin(state_dbg, "state-dbg");
    d.function<&EoffsetPerAngle::update>(this);
}

/// Computes the offset at the angle. False when a parameter is invalid.
bool EoffsetPerAngle::compute(double &offset) const noexcept {
    constexpr double FULL_TURN = 360.0;
    const double turned = angle - start_angle;
    const double multiple = fmult;
    const double radius = radius_ref;
    const double amplitude = radius * rfraction;
    if (!std::isfinite(turned) || !std::isfinite(radius) || !std::isfinite(amplitude) || !(multiple > 0.0)) {
        return false;
    }
    const double radians = std::numbers::pi / 180.0;
    const double wave = std::cos(turned * multiple * radians);
    switch (fnum) {
    case 2: offset = amplitude * 0.5 * (1.0 - wave); return true;
    case 3: offset = wave < 0.0 ? amplitude : 0.0; return true;
    default: break;
    }
    if (multiple < 3.0) {
        return false;
    }
    // The distance from the centre to a side, at an angle measured from the middle of that side.
    const double side = FULL_TURN / multiple;
    const double from_middle = std::remainder(turned, side) * radians;
    const double outer = (radius + amplitude) / std::cos(from_middle);
    offset = fnum == 1 ? outer * std::cos(0.5 * side * radians) - radius : outer - radius;
    return true;
}

EoffsetState EoffsetPerAngle::next_state(bool computed) const noexcept {
    const bool enabled = enable_in;
    if (!is_on) {
        return EOFFSET_OFF;
    }
    switch (state) {
    case EOFFSET_OFF: return enabled ? EOFFSET_OFF : EOFFSET_READY;
    case EOFFSET_READY: return enabled ? EOFFSET_ON : EOFFSET_READY;
    case EOFFSET_ON: return enabled && computed ? EOFFSET_ON : EOFFSET_RETURNING;
    case EOFFSET_RETURNING: return active ? EOFFSET_RETURNING : EOFFSET_DONE;
    default: return enabled ? EOFFSET_DONE : EOFFSET_READY;
    }
}

void EoffsetPerAngle::update() noexcept {
    constexpr std::uint32_t DEFAULT_K = 10000;
    const std::uint32_t factor = k != 0 ? k.get() : DEFAULT_K;
    double offset = 0.0;
    const bool computed = compute(offset);
    state = next_state(computed);
    const bool following = state == EOFFSET_ON && computed;
    const std::int32_t counts = following ? conv::convert<std::int32_t>(offset * factor, true).value : 0;
    is_off = !is_on;
    enable_out = state == EOFFSET_ON || state == EOFFSET_RETURNING;
    clear = state == EOFFSET_RETURNING && !enable_in;
    kcounts = counts;
    kreciprocal = 1.0 / factor;
    eoffset_dbg = static_cast<double>(counts) / factor;
    state_dbg = state;
}

}  // namespace mw::components

MW_COMPONENT(mw::components::EoffsetPerAngle, "eoffset_per_angle", mw::sdk::MANY);
