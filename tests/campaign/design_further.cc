// SPDX-License-Identifier: GPL-2.0-or-later
// Additional machines whose joints are not axes, used from plan 4 on. Every position within the travel of
// their axes can be reached, with a distance to the limits of reach and to singular poses.
#include <algorithm>

#include <fmt/format.h>

#include "base/geometry/pose.hh"
#include "campaign/design_parts.hh"

namespace mw::campaign {
namespace {

/// The travel of an axis.
struct Span {
    int axis = 0;
    double low = 0, high = 0;
};

/// Travel of a joint and its position at the start.
struct Travel {
    bool isAngular = false;
    double low = 0, high = 0, start = 0;
};

void build(plants::Random &random, Design &d, const std::vector<Span> &room,
           const std::vector<Travel> &joints) {
    d.isTrivial = false;
    for (const Span &span : room) {
        AxisDesign a =
            axis_of(span.axis, make_joint(random, geometry::isAngular(span.axis), d.isJerkLimited));
        a.low = span.low;
        a.high = span.high;
        d.axes.push_back(a);
        d.coordinates += geometry::AXIS_LETTERS[span.axis];
    }
    for (const Travel &t : joints) {
        JointDesign j = make_plain(random, t.isAngular, 1, d.isJerkLimited);
        j.low = t.low;
        j.high = t.high;
        j.start = j.home = j.home_offset = t.start;
        d.joints.push_back(j);
    }
}

void make_scara(plants::Random &random, Design &d) {
    d.name = d.kinematics = "scarakins";
    build(random, d,
          {{geometry::AXIS_X, 300, 460},
           {geometry::AXIS_Y, -150, 150},
           {geometry::AXIS_Z, 100, 300},
           {geometry::AXIS_A, -40, 40},
           {geometry::AXIS_B, -40, 40},
           {geometry::AXIS_C, -40, 40}},
          {{true, -170, 170, -50},
           {true, 5, 170, 100},
           {false, 50, 500, 290},
           {true, -360, 360, -50},
           {true, -90, 90, 0},
           {true, -90, 90, 0}});
}

void make_rotary_delta(plants::Random &random, Design &d) {
    d.name = d.kinematics = "rotarydeltakins";
    build(random, d,
          {{geometry::AXIS_X, -50, 50}, {geometry::AXIS_Y, -50, 50}, {geometry::AXIS_Z, -330, -240}},
          {{true, -120, 120, 20}, {true, -120, 120, 20}, {true, -120, 120, 20}});
    d.hal_lines = "setp rotarydeltakins.platformradius 100\nsetp rotarydeltakins.thighlength 150\n"
                  "setp rotarydeltakins.shinlength 300\nsetp rotarydeltakins.footradius 50\n";
}

void make_hexapod(plants::Random &random, Design &d) {
    d.name = d.kinematics = "genhexkins";
    build(random, d,
          {{geometry::AXIS_X, -4, 4},
           {geometry::AXIS_Y, -4, 4},
           {geometry::AXIS_Z, 16, 26},
           {geometry::AXIS_A, -10, 10},
           {geometry::AXIS_B, -10, 10},
           {geometry::AXIS_C, -10, 10}},
          std::vector<Travel>(6, {false, 10, 60, 29.7462}));
    d.hal_lines = "setp genhexkins.z 20\n";  // start of the forward search
}

void make_tilting_head(plants::Random &random, Design &d) {
    d.name = d.kinematics = "maxkins";
    std::vector<Span> room;
    std::vector<Travel> joints;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        const bool isAngular = geometry::isAngular(axis);
        const double reach = isAngular ? 40 : axis < geometry::AXIS_A ? 60 : 20;
        room.push_back({axis, -reach, reach});
        joints.push_back({isAngular, isAngular ? -720.0 : -900.0, isAngular ? 720.0 : 900.0, 0});
    }
    build(random, d, room, joints);
    d.hal_lines = fmt::format("setp maxkins.pivot-length {}\n", random.whole(1, 150));
}

void make_pentapod(plants::Random &random, Design &d) {
    d.name = d.kinematics = "pentakins";
    // The lengths of its struts at Z150. The surrounding volume has no singular poses; at lower positions the
    // joint limits exclude them.
    constexpr double LENGTHS[] = {1033.6325, 1010.2512, 929.0184, 906.3236, 864.4091};
    std::vector<Travel> struts;
    for (const double length : LENGTHS) {
        struts.push_back({false, 400, 1800, length});
    }
    build(random, d,
          {{geometry::AXIS_X, -40, 40},
           {geometry::AXIS_Y, -40, 40},
           {geometry::AXIS_Z, 110, 190},
           {geometry::AXIS_A, -6, 6},
           {geometry::AXIS_B, -6, 6}},
          struts);
    d.hal_lines = "setp pentakins.max-error 500\n";  // forward kinematics starts its search at Z0
}

void make_rose(plants::Random &random, Design &d) {
    d.name = d.kinematics = "rosekins";
    build(random, d,
          {{geometry::AXIS_X, 40, 120}, {geometry::AXIS_Y, -60, 60}, {geometry::AXIS_Z, -100, 100}},
          {{false, 1, 400, 80}, {false, -300, 300, 0}, {true, -720, 720, 0}});
}

}  // namespace

Design make_further_design(plants::Random &random) {
    Design d;
    d.isJerkLimited = random.chance(0.4);
    d.velocity = power(random, 1.6, 2.6);
    d.acceleration = power(random, 2.5, 3.8);
    using Make = void (*)(plants::Random &, Design &);
    static constexpr Make KINDS[] = {make_scara,        make_rotary_delta, make_hexapod,
                                     make_tilting_head, make_pentapod,     make_rose};
    KINDS[random.whole(0, 5)](random, d);
    return d;
}

}  // namespace mw::campaign
