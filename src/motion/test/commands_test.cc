// SPDX-License-Identifier: GPL-2.0-or-later
// Every command in every situation of the machine, compared with the table in
// docs/developer/motion_commands.md.
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/plants/spindle_plant.hh"
#include "tests/support/motion_rig.hh"

namespace mw::motion {
namespace commands_test {
namespace {

using testing::MotionRig;

/// The name in the table.
const char *word_for(Reason reason) {
    switch (reason) {
    case Reason::NONE: return "done";
    case Reason::NOT_ENABLED: return "off";
    case Reason::WRONG_MODE: return "mode";
    case Reason::MOVING: return "moving";
    case Reason::NOT_HOMED: return "not homed";
    case Reason::HOMING: return "homing";
    case Reason::NO_SUCH_JOINT: return "no such joint";
    case Reason::NO_SUCH_AXIS: return "no such axis";
    case Reason::NO_SUCH_SPINDLE: return "no such spindle";
    case Reason::NO_SUCH_OUTPUT: return "no such output";
    case Reason::NO_SUCH_PARAMETER: return "no such parameter";
    case Reason::OUT_OF_RANGE: return "out of range";
    case Reason::BEYOND_SOFT_LIMIT: return "soft limit";
    case Reason::ON_HARD_LIMIT: return "hard limit";
    case Reason::UNREACHABLE: return "unreachable";
    case Reason::JOINT_BEYOND_LIMIT: return "joint limit";
    case Reason::AMP_FAULT: return "amplifier fault";
    case Reason::EXTERNAL_ENABLE_OFF: return "enable input off";
    case Reason::NO_FEEDBACK: return "a feedback that is no number";
    case Reason::JOINT_INACTIVE: return "inactive";
    case Reason::QUEUE_FULL: return "queue full";
    case Reason::PROBE_ALREADY_TRIPPED: return "probe tripped";
    case Reason::PROBE_ALREADY_OPEN: return "probe open";
    case Reason::NOT_A_NUMBER: return "no number";
    case Reason::NO_WAY_BACK: return "no reverse run";
    case Reason::BAD_ARC: return "bad arc";
    case Reason::RIGID_TAPPING: return "not supported";
    case Reason::TAP_OFFSET: return "offsets";
    case Reason::TAP_ROOM:
    case Reason::TAP_JOINT_ROOM: return "no room";
    case Reason::ONE_WAY_SPINDLE: return "one way";
    case Reason::JOG_INHIBITED: return "inhibited";
    case Reason::HOMING_INHIBITED: return "inhibited";
    case Reason::SYNCHRONISED_JOINT: return "synchronised";
    case Reason::SWITCHED_ON: return "on";
    case Reason::TOO_FEW_JOINTS: return "too few joints";
    case Reason::NO_JOG_TO_RENEW: return "no jog";
    case Reason::SINGULAR: return "singular";
    case Reason::POSE_UNKNOWN: return "pose unknown";
    case Reason::DRIVEN_BY_PIN: return "moved by a pin";
    case Reason::INDEXER_ALONE: return "indexer alone";
    case Reason::INDEXER_OPEN: return "indexer open";
    case Reason::SIDE_APART: return "sides apart";
    case Reason::COUNT: break;
    }
    return "?";
}

enum class Situation {
    OFF,
    FREE,
    FREE_JOGGING,
    HOMING,
    TELEOP,
    TELEOP_JOGGING,
    COORD,
    COORD_MOVING,
};
constexpr Situation SITUATIONS[] = {Situation::OFF,    Situation::FREE,        Situation::FREE_JOGGING,
                                    Situation::HOMING, Situation::TELEOP,      Situation::TELEOP_JOGGING,
                                    Situation::COORD,  Situation::COORD_MOVING};

bool isAtRest(Situation situation) {
    return situation == Situation::OFF || situation == Situation::FREE || situation == Situation::TELEOP ||
           situation == Situation::COORD;
}

geometry::Pose at(double x, double y = 0, double z = 0) {
    geometry::Pose p;
    p[0] = x;
    p[1] = y;
    p[2] = z;
    return p;
}

/// End of the path so far in coord mode [X].
constexpr double PATH_END = 20;

void bring_to(MotionRig &rig, Situation situation) {
    switch (situation) {
    case Situation::OFF: return;
    case Situation::FREE: rig.ready(Mode::FREE); return;
    case Situation::FREE_JOGGING:
        rig.ready(Mode::FREE);
        rig.send(JogContinuous{{true, 0}, 20});
        break;
    case Situation::HOMING:
        rig.ready(Mode::FREE);
        rig.set(Parameter::JOINT_HOME_SEARCH_VEL, 0, 5);
        rig.set(Parameter::JOINT_HOME_LATCH_VEL, 0, 1);
        rig.send(Home{0});
        break;
    case Situation::TELEOP: rig.ready(Mode::TELEOP); return;
    case Situation::TELEOP_JOGGING:
        rig.ready(Mode::TELEOP);
        rig.send(JogContinuous{{false, 0}, 20});
        break;
    case Situation::COORD:
        rig.ready(Mode::COORD);
        rig.line(at(PATH_END), 100);
        EXPECT_TRUE(rig.run_until([&, end = rig.send_path(Flush{})] { return rig.isDone(end); }));
        return;
    case Situation::COORD_MOVING:
        rig.ready(Mode::COORD);
        rig.line(at(PATH_END), 20);
        break;
    }
    rig.step(100);
    EXPECT_FALSE(rig.status().isInPosition);
}

/// A command with valid values, and its name in LinuxCNC's manual.
struct Case {
    std::string legacy, name;
    std::variant<CommandBody, PathBody> body;
};

MoveTerms terms() {
    MoveTerms t;
    t.feed = 20;
    return t;
}
MoveTerms tapping() {
    MoveTerms t;
    t.feed_per_revolution = 0.5;
    return t;
}

std::vector<Case> cases() {
    const auto number = [](Parameter p) { return static_cast<std::uint16_t>(p); };
    const auto now = [](const CommandBody &body) { return std::variant<CommandBody, PathBody>(body); };
    const auto path = [](const PathBody &body) { return std::variant<CommandBody, PathBody>(body); };
    Arc arc;
    arc.end = at(PATH_END);
    arc.centre = at(PATH_END + 1);
    arc.normal = at(0, 0, 1);
    arc.angle_rad = 2 * 3.14159265358979323846;
    arc.terms = terms();
    Probe probe;
    probe.end = at(PATH_END, 0, -1);
    probe.mustTrip = false;
    probe.terms = terms();
    return {
        {"ABORT", "Abort", now(Abort{2})},
        {"FREE", "SetMode", now(SetMode{Mode::FREE})},
        {"TELEOP", "SetMode", now(SetMode{Mode::TELEOP})},
        {"COORD", "SetMode", now(SetMode{Mode::COORD})},
        {"ENABLE", "Enable", now(Enable{})},
        {"DISABLE", "Disable", now(Disable{})},
        {"ENABLE_AMPLIFIER", "SetAmplifier", now(SetAmplifier{1, true})},
        {"DISABLE_AMPLIFIER", "SetAmplifier", now(SetAmplifier{1, false})},
        {"ACTIVATE_JOINT", "SetJointActive", now(SetJointActive{1, true})},
        {"DEACTIVATE_JOINT", "SetJointActive", now(SetJointActive{1, false})},
        {"SET_NUM_JOINTS", "SetNumJoints", now(SetNumJoints{3})},
        {"ENABLE_WATCHDOG", "SetWatchdog", now(SetWatchdog{true, 100})},
        {"DISABLE_WATCHDOG", "SetWatchdog", now(SetWatchdog{false, 100})},
        {"", "Heartbeat", now(Heartbeat{})},
        {"PAUSE", "Pause", now(Pause{})},
        {"RESUME", "Resume", now(Resume{})},
        {"STEP", "StepOnce", now(StepOnce{})},
        {"REVERSE", "SetReverse", now(SetReverse{true})},
        {"FORWARD", "SetReverse", now(SetReverse{false})},
        {"SCALE (feed)", "SetScale", now(SetScale{Scale::FEED, 0, 0.5})},
        {"SCALE (rapid)", "SetScale", now(SetScale{Scale::RAPID, 0, 0.5})},
        {"SCALE (spindle)", "SetScale", now(SetScale{Scale::SPINDLE, 0, 0.5})},
        {"FS_ENABLE, SS_ENABLE, AF_ENABLE, FH_ENABLE", "SetSwitch", now(SetSwitch{})},
        {"SET_VEL_LIMIT", "SetMaxVelocity", now(SetMaxVelocity{50})},
        {"OVERRIDE_LIMITS", "OverrideLimits", now(OverrideLimits{})},
        {"HOME", "Home", now(Home{0})},
        {"UNHOME", "Unhome", now(Unhome{0})},
        {"JOG_CONT (joint)", "JogContinuous", now(JogContinuous{{true, 0}, 10})},
        {"JOG_CONT (axis)", "JogContinuous", now(JogContinuous{{false, 0}, 10})},
        {"JOG_CONT (renewal)", "JogContinuous", now(JogContinuous{{true, 1}, 10, 0.1, true})},
        {"JOG_INCR (joint)", "JogIncremental", now(JogIncremental{{true, 0}, 10, -1})},
        {"JOG_INCR (axis)", "JogIncremental", now(JogIncremental{{false, 0}, 10, -1})},
        {"JOG_ABS (joint)", "JogAbsolute", now(JogAbsolute{{true, 0}, 10, 3})},
        {"JOG_ABS (axis)", "JogAbsolute", now(JogAbsolute{{false, 0}, 10, 3})},
        {"JOG_ABORT (joint)", "JogStop", now(JogStop{{true, 0}})},
        {"JOG_ABORT (axis)", "JogStop", now(JogStop{{false, 0}})},
        {"SET_TELEOP_VECTOR", "SetTeleopVector", now(SetTeleopVector{at(10, 5)})},
        {"SET_LINE", "Line", path(Line{at(PATH_END + 1), terms()})},
        {"SET_CIRCLE", "Arc", path(arc)},
        {"PROBE", "Probe", path(probe)},
        {"RIGID_TAP", "RigidTap", path(RigidTap{at(PATH_END, 0, -2), 1, tapping()})},
        {"CLEAR_PROBE_FLAG", "ClearProbeFlag", now(ClearProbeFlag{})},
        {"SPINDLE_ON", "SpindleOn", now(SpindleOn{0, 100})},
        {"SPINDLE_OFF", "SpindleOff", now(SpindleOff{})},
        {"SPINDLE_ORIENT", "SpindleOrient", now(SpindleOrient{0, 90, 0})},
        {"SPINDLE_BRAKE_ENGAGE, -RELEASE", "SpindleBrake", now(SpindleBrake{0, true})},
        {"SET_DOUT (at once)", "SetDigitalOutput", now(SetDigitalOutput{0, true})},
        {"SET_AOUT (at once)", "SetAnalogOutput", now(SetAnalogOutput{0, 1.5})},
        {"SET_DOUT (in step)", "SynchedDigitalOutput", path(SynchedDigitalOutput{0, true})},
        {"SET_AOUT (in step)", "SynchedAnalogOutput", path(SynchedAnalogOutput{0, 1.5})},
        {"", "Flush", path(Flush{})},
        {"SET_OFFSET", "SetToolOffset", now(SetToolOffset{at(0, 0, 10)})},
        {"LOAD_COMP", "LoadCompensation", now(LoadCompensation{0, 0, 2, 1, 0.01, -0.01})},
        {"SET_xxx", "SetParameter", now(SetParameter{number(Parameter::JOINT_MAX_VELOCITY), 0, 80})},
    };
}

/// Result of one command in one situation.
std::string result_of(const Case &c, Situation situation) {
    SCOPED_TRACE(c.legacy + " " + c.name + " in situation " + std::to_string(static_cast<int>(situation)));
    MotionRig rig;
    bring_to(rig, situation);
    const Status before = rig.status();
    const bool isPath = std::holds_alternative<PathBody>(c.body);
    plants::SpindleTraits traits;
    traits.ramp = 200;
    plants::SpindlePlant spindle(traits);
    if (isPath && std::holds_alternative<RigidTap>(std::get<PathBody>(c.body))) {
        rig.before_step = [&](MotionRig &r) {
            spindle.run(r.out->spindle[0].speed_rpm / 60, 0, MotionRig::T);
            r.in.spindle[0].revs = spindle.shown_turns();
            r.in.spindle[0].speed_in_rps = spindle.speed();
        };
        rig.send(SpindleOn{0, 600});
        rig.step(100);
    }
    const CommandId id =
        isPath ? rig.send_path(std::get<PathBody>(c.body)) : rig.send(std::get<CommandBody>(c.body));
    constexpr int MOST_CYCLES = 10000;
    for (int n = 0; n < (isPath ? MOST_CYCLES : 1) && rig.answer_to(id) == nullptr; ++n) {
        rig.step();
    }
    const Answer *answer = rig.answer_to(id);
    if (answer == nullptr) {
        return "no answer";
    }
    const bool isRefused = answer->kind == AnswerKind::REFUSED;
    EXPECT_EQ(isRefused, answer->reason != Reason::NONE);
    const std::string word = answer->kind == AnswerKind::STALE ? "stale" : word_for(answer->reason);
    if (isRefused && isAtRest(situation)) {
        rig.step(50);
        const Status &after = rig.status();
        EXPECT_EQ(after.carte_pos_cmd, before.carte_pos_cmd) << "a rejected command moves nothing";
        EXPECT_EQ(after.isEnabled, before.isEnabled);
        EXPECT_EQ(after.mode, before.mode);
        EXPECT_EQ(after.isAllHomed, before.isAllHomed);
    }
    return word;
}

std::string table() {
    std::string text =
        "| command | declared as | off | free | free, jogging | homing | teleop | teleop, jogging | coord | "
        "coord, moving |\n|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Case &c : cases()) {
        text += "| " + c.legacy + " | " + c.name + " |";
        for (const Situation situation : SITUATIONS) {
            text += " " + result_of(c, situation) + " |";
        }
        text += "\n";
    }
    return text;
}

std::string page() {
    std::ostringstream text;
    text << std::ifstream(MW_SOURCE_DIR "/docs/developer/motion_commands.md").rdbuf();
    return text.str();
}

TEST(Commands, AreAcceptedOrRejectedAsThePageDocuments) {
    const std::string made = table();
    EXPECT_EQ(made.find("no answer"), std::string::npos);
    EXPECT_NE(page().find(made), std::string::npos) << "docs/developer/motion_commands.md should have this:\n"
                                                    << made;
}

/// A value that is not a number is rejected even if all else is valid; the current motion does not change.
TEST(Commands, ANonFiniteValueIsRejected) {
    const double nan = std::nan("");
    const geometry::Pose far = at(1, nan);
    const auto line = [](auto spoil) {
        Line move{at(1), {}};
        move.terms.feed = 20;
        spoil(move.terms);
        return move;
    };
    Arc arc;
    arc.end = at(PATH_END);
    arc.centre = at(PATH_END + 1);
    arc.normal = at(0, 0, 1);
    arc.angle_rad = nan;
    Probe probe;
    probe.end = far;
    const auto tap = [](auto spoil) {
        RigidTap move;
        move.end = at(PATH_END, 0, -2);
        move.terms.feed_per_revolution = 0.5;
        spoil(move);
        return move;
    };
    struct Wrong {
        Situation situation;
        std::variant<CommandBody, PathBody> body;
    };
    const auto now = [](Situation s, const CommandBody &body) { return Wrong{s, body}; };
    const auto path = [](const PathBody &body) { return Wrong{Situation::COORD, body}; };
    const Wrong all[] = {
        now(Situation::FREE, SetScale{Scale::FEED, 0, nan}),
        now(Situation::FREE, SetScale{Scale::RAPID, 0, nan}),
        now(Situation::FREE, SetScale{Scale::SPINDLE, 0, nan}),
        now(Situation::FREE, SetMaxVelocity{nan}),
        now(Situation::FREE, SetWatchdog{true, nan}),
        now(Situation::FREE, JogContinuous{{true, 0}, nan}),
        now(Situation::FREE, JogContinuous{{true, 0}, 0}),
        now(Situation::FREE, JogContinuous{{true, 0}, 5, nan}),
        now(Situation::FREE, JogIncremental{{true, 0}, nan, 1}),
        now(Situation::FREE, JogIncremental{{true, 0}, 5, nan}),
        now(Situation::FREE, JogAbsolute{{true, 0}, nan, 1}),
        now(Situation::FREE, JogAbsolute{{true, 0}, 5, nan}),
        now(Situation::TELEOP, JogContinuous{{false, 0}, nan}),
        now(Situation::TELEOP, SetTeleopVector{far}),
        now(Situation::FREE, SpindleOn{0, nan}),
        now(Situation::FREE, SpindleOn{0, 100, nan}),
        now(Situation::FREE, SpindleOn{0, 100, 1, nan}),
        now(Situation::FREE, SpindleOn{0, 100, 1, 1, nan}),
        now(Situation::FREE, SpindleOrient{0, nan}),
        now(Situation::FREE, SetAnalogOutput{0, nan}),
        now(Situation::FREE, SetToolOffset{far}),
        now(Situation::FREE, SetParameter{static_cast<std::uint16_t>(Parameter::JOINT_MAX_VELOCITY), 0, nan}),
        path(Line{far, {}}),
        path(line([&](MoveTerms &t) { t.feed = nan; })),
        path(line([&](MoveTerms &t) { t.tolerance = nan; })),
        path(line([&](MoveTerms &t) { t.naivecam_tolerance = nan; })),
        path(line([&](MoveTerms &t) { t.corner_scale = nan; })),
        path(line([&](MoveTerms &t) { t.feed_per_revolution = nan; })),
        path(line([&](MoveTerms &t) { t.synch_spindle = -1; })),
        path(arc),
        path(probe),
        path(tap([&](RigidTap &t) { t.end = far; })),
        path(tap([&](RigidTap &t) { t.end = at(PATH_END); })),
        path(tap([&](RigidTap &t) { t.pitch_scale = nan; })),
        path(tap([&](RigidTap &t) { t.pitch_scale = 0; })),
        path(tap([&](RigidTap &t) { t.terms.feed_per_revolution = 0; })),
        path(tap([&](RigidTap &t) { t.terms.feed_per_revolution = -1; })),
        path(tap([&](RigidTap &t) { t.terms.feed_per_revolution = nan; })),
        path(tap([&](RigidTap &t) { t.terms.synch_spindle = 1; })),
        path(SynchedAnalogOutput{0, nan}),
    };
    int number = 0;
    for (const Wrong &wrong : all) {
        SCOPED_TRACE(number++);
        const std::string word = result_of({"", "", wrong.body}, wrong.situation);
        EXPECT_NE(word, "done");
        EXPECT_NE(word, "no answer");
    }
}

/// A value that is not finite is not a number, with either sign.
TEST(Commands, ANonFinitePitchScaleIsReported) {
    for (const double scale : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(
            result_of({"", "", PathBody{RigidTap{at(PATH_END, 0, -2), scale, tapping()}}}, Situation::COORD),
            "no number")
            << scale;
    }
}

/// The planner runs only every few cycles: by then the last move may have ended and its path may be dropped.
TEST(Commands, AMoveThatEndedBeforeAStopIsDone) {
    for (const bool isOver : {true, false}) {
        MotionRig rig;
        rig.ready(Mode::COORD);
        const CommandId move = rig.line(at(2), 50);
        ASSERT_TRUE(rig.run_until([&] { return rig.status().carte_pos_cmd[0] > 0.5; }, 1));
        rig.isPlannerAlive = false;
        rig.step(isOver ? 100 : 1);
        ASSERT_EQ(rig.status().carte_pos_cmd[0] == 2, isOver);
        rig.send(Abort{++rig.epoch});
        rig.step();
        ASSERT_EQ(rig.answer_to(move), nullptr);
        rig.isPlannerAlive = true;
        ASSERT_TRUE(rig.run_until([&] { return rig.answer_to(move) != nullptr; }, 1));
        EXPECT_EQ(rig.answer_to(move)->kind, isOver ? AnswerKind::DONE : AnswerKind::STALE);
        rig.step();
        EXPECT_EQ(rig.status().last_path_id, isOver ? move : 0);
    }
}

/// Each alternative of the two channels has a row in the table and is described.
TEST(Commands, EveryDeclarationIsOnThePage) {
    std::set<std::size_t> immediate, path;
    const std::string text = page();
    for (const Case &c : cases()) {
        if (const auto *body = std::get_if<CommandBody>(&c.body)) {
            immediate.insert(body->index());
        } else {
            path.insert(std::get<PathBody>(c.body).index());
        }
        EXPECT_NE(text.find("`" + c.name + "`"), std::string::npos) << c.name << " is not described";
    }
    EXPECT_EQ(immediate.size(), std::variant_size_v<CommandBody>);
    EXPECT_EQ(path.size(), std::variant_size_v<PathBody>);
}

}  // namespace
}  // namespace commands_test
}  // namespace mw::motion
