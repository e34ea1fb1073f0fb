// SPDX-License-Identifier: GPL-2.0-or-later
#include "kinematics/test/all_models.hh"

#include <cmath>

#include "kinematics/bridge_mill.hh"
#include "kinematics/corexy.hh"
#include "kinematics/hexapod.hh"
#include "kinematics/linear_delta.hh"
#include "kinematics/matrix.hh"
#include "kinematics/nutating_head.hh"
#include "kinematics/ortho_parallel.hh"
#include "kinematics/pentapod.hh"
#include "kinematics/puma.hh"
#include "kinematics/rose.hh"
#include "kinematics/rotary_delta.hh"
#include "kinematics/rotary_table.hh"
#include "kinematics/rotate.hh"
#include "kinematics/scara.hh"
#include "kinematics/scorbot.hh"
#include "kinematics/serial.hh"
#include "kinematics/tilting_head.hh"
#include "kinematics/tilting_table.hh"
#include "kinematics/tripod.hh"

namespace mw::kinematics::test {

namespace {

constexpr Span MM{-300, 300};
constexpr Span TURN{-175, 175};
constexpr Span TILT{-85, 85};
constexpr double PI = 3.14159265358979323846;

/// Inside, outside, or unknown when the distance from the edge is within rounding errors.
Verdict verdict_of(double value, double low, double high, double margin) {
    if (value > low + margin && value < high - margin) {
        return Verdict::REACHABLE;
    }
    return value < low - margin || value > high + margin ? Verdict::UNREACHABLE : Verdict::UNKNOWN;
}

template <class Model>
std::shared_ptr<Model> with(std::initializer_list<double> values) {
    auto model = std::make_shared<Model>();
    std::size_t i = 0;
    for (const double value : values) {
        model->set(i++, value);
    }
    return model;
}

/// Sets every length and angle of the head.
template <class Head>
std::shared_ptr<Head> head_in(HeadFrame frame) {
    auto head = with<Head>({70, -120, -400, 50, 120, 6, -9, 55, 0.3, 25, -130});
    head->set_frame(frame);
    return head;
}

/// Adds the machines that reach every pose.
void add_cartesian(std::vector<ModelCase> &out) {
    const std::vector<Span> nine{MM, MM, MM, TURN, TILT, TURN, MM, MM, MM};
    const auto add = [&](const char *name, std::shared_ptr<const Kinematics> model, const char *axes,
                         std::vector<Span> poses) {
        ModelCase one;
        one.name = name;
        one.model = std::move(model);
        one.axes = axes;
        one.joints = poses;
        one.home.assign(poses.size(), 0.0);
        one.poses = std::move(poses);
        one.size = 300;
        out.push_back(std::move(one));
    };
    const std::vector<Span> five{MM, MM, MM, TILT, TURN};
    auto table = std::make_shared<RotaryTable>();
    table->set_tilt_axis(12, -35);
    auto long_bridge = with<BridgeMill>({180.5});
    long_bridge->set_letters("XYZBCWYV");
    add("corexy", std::make_shared<CoreXy>(), "XYZABCUVW", nine);
    add("rotary_table", table, "XYZAC", five);
    add("rotate", std::make_shared<Rotate>(), "XYZABCUVW", nine);
    add("matrix", with<Matrix>({0.99, 0.01, 0.03, -0.02, 1.01, 0.005, 0.004, -0.01, 1.05}), "XYZABCUVW",
        nine);
    add("bridge_mill", with<BridgeMill>({250}), "XYZBCW", {MM, MM, MM, TILT, TURN, MM});
    add("bridge_mill_two_y", long_bridge, "XYZBCWYV", {MM, MM, MM, TILT, TURN, MM, MM, MM});
    out.back().joints.clear();  // random positions for the joints of one letter would not match
    add("tilting_head", with<TiltingHead>({120}), "XYZABCUVW", nine);
    add("xyzac_table", with<XyzacTable>({10, -20, 30, 4, 5, -6, 70}), "XYZAC", five);
    add("xyzbc_table", with<XyzbcTable>({10, -20, 30, 4, 5, -6, 70}), "XYZBC", five);
    add("xyzab_table", with<XyzabTable>({50, 3, -12, 10, -20, 30}), "XYZAB", {MM, MM, MM, TURN, TURN});
    const std::vector<Span> six{MM, MM, MM, TURN, TURN, TURN};
    add("head_over_a", head_in<NutatingHeadOverA>(HeadFrame::WORK), "XYZABC", six);
    add("head_over_b", head_in<NutatingHeadOverB>(HeadFrame::WORK), "XYZABC", six);
    add("head_over_a_in_plane", head_in<NutatingHeadOverA>(HeadFrame::TOOL), "XYZABC", six);
    add("head_over_b_in_plane", head_in<NutatingHeadOverB>(HeadFrame::TOOL), "XYZABC", six);
}

/// Adds the machines that hold a point by three links, and the rose engine.
void add_points(std::vector<ModelCase> &out) {
    ModelCase tripod{"tripod",
                     with<Tripod>({400, 150, 350}),
                     "XYZ",
                     {MM, MM, {-600, 600}},
                     {{300, 700}, {300, 700}, {300, 700}},
                     {500, 500, 500},
                     400};
    out.push_back(std::move(tripod));
    ModelCase rose{
        "rose", std::make_shared<Rose>(), "XYZ", {MM, MM, MM}, {{1, 300}, MM, {-3000, 3000}}, {1, 0, 0}, 300};
    out.push_back(std::move(rose));

    ModelCase linear{"linear_delta",
                     with<LinearDelta>({130.25, 269}),
                     "XYZABCUVW",
                     {{-250, 250}, {-250, 250}, MM, TURN, TURN, TURN, MM, MM, MM},
                     {MM, MM, MM, TURN, TURN, TURN, MM, MM, MM},
                     std::vector<double>(9, 0.0),
                     269};
    linear.judge = [](const Pose &p) {
        // The upper ends of the rods, and the side of their plane on which the effector is.
        double ends[3][3];
        for (int i = 0; i < 3; ++i) {
            const double angle = (90 + 120 * i) * PI / 180;
            const double x = 130.25 * std::cos(angle) - p[0];
            const double y = 130.25 * std::sin(angle) - p[1];
            const double rest = 269.0 * 269.0 - x * x - y * y;
            if (std::abs(rest) < 1e-3) {
                return Verdict::UNKNOWN;
            }
            if (rest < 0) {
                return Verdict::UNREACHABLE;
            }
            ends[i][0] = x;
            ends[i][1] = y;
            ends[i][2] = std::sqrt(rest);
        }
        // Position of the effector's projection on the plane through the ends, as weights of the ends.
        const auto area = [&](int i, int j) { return ends[i][0] * ends[j][1] - ends[j][0] * ends[i][1]; };
        const double whole = area(0, 1) + area(1, 2) + area(2, 0);
        const double height =
            (area(1, 2) * ends[0][2] + area(2, 0) * ends[1][2] + area(0, 1) * ends[2][2]) / whole;
        return verdict_of(height, 0, 1e9, 1e-3);
    };
    out.push_back(std::move(linear));

    ModelCase rotary{"rotary_delta",
                     with<RotaryDelta>({100, 100, 140, 60}),
                     "XYZABCUVW",
                     {{-200, 200}, {-200, 200}, {-230, -10}, TURN, TURN, TURN, MM, MM, MM},
                     {{-60, 100}, {-60, 100}, {-60, 100}, TURN, TURN, TURN, MM, MM, MM},
                     std::vector<double>(9, 0.0),
                     140};
    rotary.judge = [](const Pose &p) {
        // The knee moves on a circle: is the length of the shin between the minimum and maximum distance?
        Verdict verdict = Verdict::UNKNOWN;
        for (int i = 0; i < 3; ++i) {
            const double angle = (270 + 120 * i) * PI / 180;
            const double out_mm = p[0] * std::cos(angle) + p[1] * std::sin(angle) + 60 - 100;
            const double beside = p[1] * std::cos(angle) - p[0] * std::sin(angle);
            const double reach = std::hypot(out_mm, p[2]);
            const double nearest = std::hypot(reach - 100, beside);
            const double farthest = std::hypot(reach + 100, beside);
            if (verdict_of(140, nearest, farthest, 1e-3) == Verdict::UNREACHABLE) {
                verdict = Verdict::UNREACHABLE;
            }
        }
        return verdict;  // this check does not know the configuration of the legs
    };
    out.push_back(std::move(rotary));
}

/// Compares the distance of a wrist from its shoulder with the lengths of two arms.
Verdict arm_verdict(double distance, double one, double other) {
    return verdict_of(distance, std::abs(one - other), one + other, 1e-4 * (one + other));
}

Verdict puma_verdict(const Pose &p, double d6) {
    const double a = p[3] * PI / 180;
    const double b = p[4] * PI / 180;
    const double c = p[5] * PI / 180;
    // The third column of Rz(c) Ry(b) Rx(a).
    const double x = p[0] - d6 * (std::cos(c) * std::sin(b) * std::cos(a) + std::sin(c) * std::sin(a));
    const double y = p[1] - d6 * (std::sin(c) * std::sin(b) * std::cos(a) - std::cos(c) * std::sin(a));
    const double z = p[2] - d6 * std::cos(b) * std::cos(a);
    const double level = x * x + y * y - 70.0 * 70.0;
    if (std::abs(level) < 1) {
        return Verdict::UNKNOWN;
    }
    return level < 0 ? Verdict::UNREACHABLE : arm_verdict(std::sqrt(level + z * z), 300, std::hypot(50, 400));
}

/// For an arm with the shoulder ahead; lengths a1 a2 b c1 c2 c3 c4.
Verdict ortho_parallel_verdict(const Pose &p, const std::array<double, 7> &l) {
    const double a = p[3] * PI / 180;
    const double b = p[4] * PI / 180;
    const double c = p[5] * PI / 180;
    const double x = p[0] - l[6] * (std::cos(c) * std::sin(b) * std::cos(a) + std::sin(c) * std::sin(a));
    const double y = p[1] - l[6] * (std::sin(c) * std::sin(b) * std::cos(a) - std::cos(c) * std::sin(a));
    const double z = p[2] - l[6] * std::cos(b) * std::cos(a) - l[3];
    const double level = x * x + y * y - l[2] * l[2];
    if (std::abs(level) < 1) {
        return Verdict::UNKNOWN;
    }
    return level < 0 ? Verdict::UNREACHABLE
                     : arm_verdict(std::hypot(std::sqrt(level) - l[0], z), l[4], std::hypot(l[1], l[5]));
}

void add_arms(std::vector<ModelCase> &out) {
    ModelCase scara{"scara",
                    with<Scara>({490, 340, 50, 250, 50, 50}),
                    "XYZABC",
                    {{-700, 700}, {-700, 700}, MM, TURN, TURN, {-500, 500}},
                    {{-720, 720}, {-720, 720}, MM, {-720, 720}, TURN, TURN},
                    {0, -40, 0, 0, 0, 0},
                    640};
    scara.judge = [](const Pose &p) {
        const double c = p[5] * PI / 180;
        return arm_verdict(std::hypot(p[0] - 50 * std::cos(c), p[1] - 50 * std::sin(c)), 340, 250);
    };
    out.push_back(std::move(scara));

    ModelCase scorbot{"scorbot",
                      std::make_shared<Scorbot>(),
                      "XYZAB",
                      {{-500, 500}, {-500, 500}, MM, TURN, TURN},
                      {{-500, 500}, {-60, 60}, {-60, 60}, TURN, TURN},
                      {0, 30, -30, 0, 0},
                      458};
    scorbot.judge = [](const Pose &p) {
        return arm_verdict(std::hypot(std::hypot(p[0], p[1]) - 16, p[2] - 140), 221, 221);
    };
    out.push_back(std::move(scorbot));

    const std::vector<Span> hand{{-800, 800}, {-800, 800}, {-800, 800}, TURN, {-85, 85}, TURN};
    const std::vector<Span> six(6, Span{-500, 500});
    ModelCase puma{"puma", with<Puma>({300, 50, 70, 400, 70}), "XYZABC", hand,
                   six,    {0, -45, 10, 20, 30, 40},           820};
    puma.are_angles_rpy = true;
    puma.judge = [](const Pose &p) { return puma_verdict(p, 70); };
    out.push_back(std::move(puma));

    constexpr std::array<double, 7> ARM{25, -35, 12, 400, 315, 365, 80};
    ModelCase ortho{"ortho_parallel",
                    with<OrthoParallel>({ARM[0], ARM[1], ARM[2], ARM[3], ARM[4], ARM[5], ARM[6]}),
                    "XYZABC",
                    {{-800, 800}, {-800, 800}, {-400, 1200}, TURN, {-85, 85}, TURN},
                    six,
                    {0, 30, 60, 20, 30, 40},
                    820};
    ortho.are_angles_rpy = true;
    ortho.judge = [ARM](const Pose &p) { return ortho_parallel_verdict(p, ARM); };
    out.push_back(std::move(ortho));

    ModelCase serial{"serial", std::make_shared<Serial>(), "XYZABC", hand,
                     six,      {0, -45, 10, 20, 30, 40},   820};
    serial.are_angles_rpy = true;
    serial.iterating = true;
    serial.judge = [](const Pose &p) {
        // This judge does not know which poses can be reached on a straight line without a singular pose.
        return puma_verdict(p, 0) == Verdict::UNREACHABLE ? Verdict::UNREACHABLE : Verdict::UNKNOWN;
    };
    out.push_back(std::move(serial));
}

void add_platforms(std::vector<ModelCase> &out) {
    ModelCase hexapod{"hexapod", std::make_shared<Hexapod>(),
                      "XYZABC",  {{-6, 6}, {-6, 6}, {15, 30}, {-15, 15}, {-15, 15}, {-15, 15}},
                      {},        std::vector<double>(6, 30.0),
                      25};
    hexapod.are_angles_rpy = true;
    hexapod.iterating = true;
    ModelCase screwed = hexapod;
    screwed.name = "hexapod_with_screws";
    auto with_screws = std::make_shared<Hexapod>();
    with_screws->set(Hexapod::SCREW_LEAD, 0.5);
    with_screws->set(Hexapod::TOOL_OFFSET, -3);
    with_screws->set(Hexapod::SPINDLE_OFFSET, 2);
    screwed.model = with_screws;
    ModelCase pentapod{"pentapod", std::make_shared<Pentapod>(),
                       "XYZAB",    {{-150, 150}, {-150, 150}, {-150, 150}, {-25, 25}, {-25, 25}},
                       {},         std::vector<double>(5, 1000.0),
                       1000};
    pentapod.iterating = true;
    out.push_back(std::move(hexapod));
    out.push_back(std::move(screwed));
    out.push_back(std::move(pentapod));
}

}  // namespace

const std::vector<ModelCase> &all_models() {
    static const std::vector<ModelCase> models = [] {
        std::vector<ModelCase> out;
        add_cartesian(out);
        add_points(out);
        add_arms(out);
        add_platforms(out);
        return out;
    }();
    return models;
}

}  // namespace mw::kinematics::test
