// SPDX-License-Identifier: GPL-2.0-or-later
#include "traj/kinds.hh"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace mw::bench {

namespace {

constexpr double PI = std::numbers::pi;
constexpr double FEED = 200;  ///< mm/s, as the axes' own limit
constexpr double ROTARY_SPEED = 120, ROTARY_ACCELERATION = 800, ROTARY_JERK = 40000;

/// Rounds numbers like a post-processor.
double rounded(double x) {
    return std::round(x * 1e4) * 1e-4;
}

class Writer {
  public:
    Writer(const char *name, double tolerance) {
        program_.name = name;
        program_.tolerance = tolerance;
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            const bool isRotary = geometry::isAngular(i);
            program_.max_velocity[i] = isRotary ? ROTARY_SPEED : 200;
            program_.max_acceleration[i] = isRotary ? ROTARY_ACCELERATION : 1000;
            program_.max_jerk[i] = isRotary ? ROTARY_JERK : 50000;
        }
    }
    void start(const Pose &p) {
        at_ = p;
        program_.start = p;
    }
    void to(double x, double y, double z = 0) {
        Pose p = at_;
        p[0] = rounded(x);
        p[1] = rounded(y);
        p[2] = rounded(z);
        line(p);
    }
    void line(const Pose &p) {
        if (p == at_) {
            return;
        }
        Move m;
        m.end = p;
        push(m);
    }
    /// An arc about (cx, cy) by `angle`, with a rise of `dz`.
    void arc(double cx, double cy, double angle, double dz = 0) {
        Move m;
        m.isArc = true;
        m.centre = at_;
        m.centre[0] = cx;
        m.centre[1] = cy;
        m.normal[2] = 1;
        m.angle_rad = angle;
        const double x = at_[0] - cx;
        const double y = at_[1] - cy;
        m.end = at_;
        m.end[0] = cx + x * std::cos(angle) - y * std::sin(angle);
        m.end[1] = cy + x * std::sin(angle) + y * std::cos(angle);
        m.end[2] += dz;
        push(m);
    }
    double feed = FEED;
    geometry::PathMode control = geometry::PathMode::BLEND;
    const Pose &at() const { return at_; }
    Program done() { return std::move(program_); }

  private:
    void push(Move m) {
        m.feed = feed;
        m.control = control;
        at_ = m.end;
        program_.moves.push_back(m);
    }
    Program program_;
    Pose at_;
};

Pose xyz(double x, double y, double z = 0) {
    Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

Program square_corners() {
    Writer w("square corners", 0.02);
    for (int i = 1; i <= 12; ++i) {
        const double x = 20.0 * i;
        w.to(x, i % 2 == 1 ? 0 : 15);
        w.to(x, i % 2 == 1 ? 15 : 0);
    }
    return w.done();
}

Program acute_corners() {
    Writer w("acute corners", 0.02);
    for (int i = 1; i <= 20; ++i) {
        w.to(6.0 * i, i % 2 == 1 ? 22 : 0);
    }
    return w.done();
}

Program colinear() {
    Writer w("colinear 0.05 mm", 0.01);
    for (int side = 0; side < 4; ++side) {
        const Pose from = w.at();
        const double angle = side * PI / 2 + 0.3;
        for (int i = 1; i <= 600; ++i) {
            w.to(from[0] + 0.05 * i * std::cos(angle), from[1] + 0.05 * i * std::sin(angle));
        }
    }
    return w.done();
}

Program circles_by_chords() {
    Writer w("circles by chords", 0.02);
    for (const double r : {3.0, 8.0, 20.0}) {
        const Pose c = w.at() + xyz(-r, 0);
        const int n = static_cast<int>(std::ceil(2 * PI / (2 * std::acos(1 - 0.002 / r))));
        for (int i = 1; i <= 2 * n; ++i) {
            w.to(c[0] + r * std::cos(2 * PI * i / n), c[1] + r * std::sin(2 * PI * i / n));
        }
        w.to(c[0] + r, c[1] + 30);
    }
    return w.done();
}

Program circles_by_arcs() {
    Writer w("circles by arcs", 0.02);
    for (const double r : {3.0, 8.0, 20.0}) {
        const double cx = w.at()[0] - r;
        const double cy = w.at()[1];
        for (int i = 0; i < 4; ++i) {
            w.arc(cx, cy, PI);
        }
        w.to(cx + r, cy + 30);
    }
    return w.done();
}

Program surface_raster() {
    Writer w("surface raster", 0.01);
    const auto height = [](double x, double y) {
        return 2.0 * std::sin(x / 6) * std::cos(y / 7) + 0.6 * std::sin(x / 1.7 + 0.4 * y);
    };
    w.start(xyz(0, 0, rounded(height(0, 0))));
    for (int row = 0; row < 6; ++row) {
        const double y = 0.5 * row;
        double x = row % 2 == 0 ? 0 : 50;
        const double sign = row % 2 == 0 ? 1 : -1;
        w.to(x, y, height(x, y));
        while (sign > 0 ? x < 50 : x > 0) {
            // Chords within a micrometre of the surface, as a CAM system creates them.
            const double h = 0.05;
            const double bend = std::abs(height(x + h, y) - 2 * height(x, y) + height(x - h, y)) / (h * h);
            x += sign * std::clamp(std::sqrt(8 * 0.001 / std::max(bend, 1e-3)), 0.05, 1.0);
            x = std::clamp(x, 0.0, 50.0);
            w.to(x, y, height(x, y));
        }
    }
    return w.done();
}

Program trochoids() {
    Writer w("trochoids", 0.02);
    const double r = 2.5;
    for (int i = 0; i < 25; ++i) {
        const double cx = w.at()[0] - r;
        w.arc(cx, 0, 2 * PI);
        w.to(w.at()[0] + 0.6, 0);
    }
    return w.done();
}

Program helical_spiral() {
    Writer w("helical spiral", 0.02);
    w.start(xyz(4, 0));
    double side = 1;
    double r = 4;
    for (int i = 0; i < 24; ++i) {
        const double next = r + 0.25;
        const double cx = w.at()[0] - side * 0.5 * (r + next);
        w.arc(cx, 0, PI, -0.1);
        side = -side;
        r = next;
    }
    return w.done();
}

Program engraving() {
    Writer w("engraving", 0.01);
    std::mt19937 random(5);
    const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    for (int letter = 0; letter < 25; ++letter) {
        const double x = 3.0 * letter;
        w.feed = 0;
        w.to(w.at()[0], w.at()[1], 1);
        w.to(x, 0, 1);
        w.feed = 50;
        w.to(x, 0, 0);
        for (int stroke = 0; stroke < 4; ++stroke) {
            const Pose back = w.at();
            w.to(x + 2 * unit(), 3 * unit());
            if (stroke % 2 == 0) {
                w.to(back[0], back[1]);  // out and back on the same line
            }
        }
        for (int i = 1; i <= 12; ++i) {
            const double a = PI * i / 12;
            w.to(x + 1 - std::cos(a), 1.5 + 1.2 * std::sin(a));
        }
    }
    return w.done();
}

Program five_axes() {
    Writer w("XYZAB", 0.02);
    const auto pose_at = [](double t) {
        Pose p = xyz(rounded(25 * std::cos(t)), rounded(18 * std::sin(t)), rounded(4 * std::sin(3 * t)));
        p[geometry::AXIS_A] = rounded(20 * std::sin(2 * t));
        p[geometry::AXIS_B] = rounded(25 * std::cos(t + 0.5));
        return p;
    };
    w.start(pose_at(0));
    for (int i = 1; i <= 720; ++i) {
        w.line(pose_at(i * 0.0175));
    }
    return w.done();
}

Program lathe_profile() {
    Writer w("lathe profile", 0.02);
    w.start(xyz(10, 0, 2));
    w.feed = 30;
    for (int pass = 0; pass < 4; ++pass) {
        const double d = 10 - pass;
        w.to(d, 0, 0);
        w.to(d, 0, -8);
        w.to(d + 2, 0, -11);
        w.to(d + 2, 0, -20);
        for (int i = 1; i <= 30; ++i) {
            const double a = PI / 2 * i / 30;
            w.to(d + 2 + 4 * (1 - std::cos(a)), 0, -20 - 4 * std::sin(a));
        }
        w.to(d + 8, 0, -24);
        w.feed = 0;
        w.to(d + 8, 0, 2);
        w.feed = 30;
    }
    return w.done();
}

Program rapids() {
    Writer w("rapids", 0.02);
    std::mt19937 random(11);
    const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    w.feed = 0;
    for (int i = 0; i < 20; ++i) {
        w.to(w.at()[0], w.at()[1], 5);
        w.to(150 * unit(), 100 * unit(), 5);
        w.to(w.at()[0], w.at()[1], 0);
    }
    return w.done();
}

Program exact(const char *name, geometry::PathMode control) {
    Writer w(name, 0.02);
    w.control = control;
    for (int i = 0; i < 8; ++i) {
        const double x = 25.0 * i;
        w.to(x + 10, 0);
        w.arc(x + 10, 4, PI / 2);
        w.to(x + 14, 12);
        w.to(x + 25, 12);
        w.to(x + 25, 6);
        w.to(x + 25, 0);
    }
    return w.done();
}

}  // namespace

std::vector<Program> all_kinds() {
    std::vector<Program> all;
    all.push_back(square_corners());
    all.push_back(acute_corners());
    all.push_back(colinear());
    all.push_back(circles_by_chords());
    all.push_back(circles_by_arcs());
    all.push_back(surface_raster());
    all.push_back(trochoids());
    all.push_back(helical_spiral());
    all.push_back(engraving());
    all.push_back(five_axes());
    all.push_back(lathe_profile());
    all.push_back(rapids());
    all.push_back(exact("G61", geometry::PathMode::EXACT_PATH));
    all.push_back(exact("G61.1", geometry::PathMode::EXACT_STOP));
    return all;
}

Program dense_nine_axes(int blocks) {
    Writer w("nine axes 0.01 mm", 0.01);
    w.feed = 20000.0 / 60.0;
    const auto pose_at = [](double t) {
        Pose p;
        for (int i = 0; i < geometry::AXIS_COUNT; ++i) {
            const double size = i == 0 ? 400.0 : 12.0;
            p[i] = size * std::sin(t * (i == 0 ? 0.01 : 0.13 + 0.011 * i) + i) - size * std::sin(i);
        }
        return p;
    };
    for (int i = 1; i <= blocks; ++i) {
        w.line(pose_at(i * 0.0016));
    }
    Program program = w.done();
    program.max_velocity = {{400, 400, 400, 400, 400, 400, 400, 400, 400}};
    return program;
}

Pose position_on(const Pose &from, const Move &move, double part) {
    Pose p = from + (move.end - from) * part;
    if (!move.isArc) {
        return p;
    }
    // Arcs in these programs are in planes parallel to XY.
    const double a = move.angle_rad * part * (move.normal[2] < 0 ? -1 : 1);
    const double x = from[0] - move.centre[0];
    const double y = from[1] - move.centre[1];
    p[0] = move.centre[0] + x * std::cos(a) - y * std::sin(a);
    p[1] = move.centre[1] + x * std::sin(a) + y * std::cos(a);
    return p;
}

std::vector<Pose> sample_path(const Program &program, double step) {
    std::vector<Pose> points{program.start};
    Pose from = program.start;
    for (const Move &m : program.moves) {
        const double around = m.isArc ? std::abs(m.angle_rad) * geometry::norm_xyz(from - m.centre) : 0.0;
        const double length = std::max(around, geometry::norm(m.end - from));
        const int n = std::max(1, static_cast<int>(std::ceil(length / step)));
        for (int i = 1; i < n; ++i) {
            points.push_back(position_on(from, m, static_cast<double>(i) / n));
        }
        points.push_back(m.end);
        from = m.end;
    }
    return points;
}

}  // namespace mw::bench
