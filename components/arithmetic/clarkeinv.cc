// SPDX-License-Identifier: GPL-2.0-or-later
// clarkeinv: three phases a, b, c from the vector (x, y), rotated by `theta` [turns], and the common part h.
// Pins float. The inverse of clarke3.
#include <cmath>
#include <numbers>

#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct Clarkeinv {
    In<double> x, y, h, theta;
    Out<double> a, b, c;

    void declare(Declare &d) noexcept {
        d.pin(x, "x");
        d.pin(y, "y");
        d.pin(h, "h");
        d.pin(theta, "theta");
        d.pin(a, "a");
        d.pin(b, "b");
        d.pin(c, "c");
        d.function<&Clarkeinv::update>(this);
    }

    void update() noexcept {
        const double angle = 2.0 * std::numbers::pi * theta;
        const double cosine = std::cos(angle);
        const double sine = std::sin(angle);
        const double turned_x = x * cosine - y * sine;
        const double turned_y = x * sine + y * cosine;
        const double common = h / std::numbers::sqrt2;
        const double half_root3 = std::numbers::sqrt3 / 2.0;
        a = turned_x + common;
        b = -0.5 * turned_x + half_root3 * turned_y + common;
        c = -0.5 * turned_x - half_root3 * turned_y + common;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Clarkeinv, "clarkeinv", mw::sdk::MANY);
