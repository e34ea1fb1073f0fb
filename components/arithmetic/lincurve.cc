// SPDX-License-Identifier: GPL-2.0-or-later
// lincurve: `out` follows `in` along straight lines between points, 2 to 16 an instance (`personality=`, 2 by
// default).
//
// The points are parameters x-val-NN and y-val-NN, x increasing. Left of the first point and right of the
// last point `out` has the value of that point. `out-io` is the same value as an I/O pin. All float.
#include <algorithm>

#include "hal/sdk/component.hh"

MW_PERSONALITY("points of each instance");

namespace mw::components {
using namespace sdk;

struct Lincurve {
    static constexpr int MIN_POINTS = 2;
    static constexpr int MAX_POINTS = 16;
    int points = 0;
    In<double> in;
    Out<double> out;
    InOut<double> out_io;
    ParamRw<double> x[MAX_POINTS], y[MAX_POINTS];

    void declare(Declare &d) noexcept {
        declare_points(d);
        d.pin(in, "in");
        d.pin(out, "out");
        d.pin(out_io, "out-io");
        for (int i = 0; i < points; ++i) {
            d.param_at(x[i], "x-val-%02d", i);
            d.param_at(y[i], "y-val-%02d", i);
        }
        d.function<&Lincurve::update>(this);
    }

    void update() noexcept {
        const double value = at(in);
        out = value;
        out_io = value;
    }

  private:
    /// LinuxCNC limits the number of points without a message, so configurations for it may contain any
    /// number.
    void declare_points(Declare &d) noexcept {
        const int wanted = personality[d.index()];
        points = std::clamp(wanted, MIN_POINTS, MAX_POINTS);
        if (wanted != 0 && wanted != points) {
            rtapi_print_msg(RTAPI_MSG_WARN,
                            "%s: personality=%d, but the number of points is %d to %d. It is set to %d.\n",
                            d.prefix(), wanted, MIN_POINTS, MAX_POINTS, points);
        }
    }

    double at(double wanted) const noexcept {
        if (!(wanted > x[0])) {
            return y[0];
        }
        for (int i = 1; i < points; ++i) {
            if (wanted <= x[i]) {
                const double part = (wanted - x[i - 1]) / (x[i] - x[i - 1]);
                return y[i - 1] + part * (y[i] - y[i - 1]);
            }
        }
        return y[points - 1];
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Lincurve, "lincurve", mw::sdk::MANY);
