// SPDX-License-Identifier: GPL-2.0-or-later
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "motion/logger/stand_in.hh"

namespace mw::motion {
namespace {

class LoggerTest : public testing::Test {
  protected:
    void send(const CommandBody &body) { channels->immediate.push({++id, epoch, body}); }
    void move(const PathBody &body) { channels->path.push({++id, epoch, body}); }
    void set(Parameter parameter, int index, double value) {
        SetParameter setting;
        setting.parameter = static_cast<std::uint16_t>(parameter);
        setting.index = static_cast<std::int16_t>(index);
        setting.value = value;
        send(setting);
    }
    /// A machine of nine axes with the same limits.
    void configure() {
        for (int i = 0; i < MAX_AXES; ++i) {
            set(Parameter::AXIS_MAX_VELOCITY, i, 4);
            set(Parameter::AXIS_MAX_ACCELERATION, i, 1000);
        }
        set(Parameter::JOINT_MIN_LIMIT, 0, -40);
        set(Parameter::JOINT_MAX_LIMIT, 0, 40);
        send(SetNumJoints{1});
        said();
    }
    std::string said() {
        log.clear();
        stand_in.step(0);
        return log;
    }
    static Line line(const geometry::Pose &end, bool isRapid, double feed, int number) {
        Line line;
        line.end = end;
        line.terms.isRapid = isRapid;
        line.terms.feed = feed;
        line.terms.source.line = number;
        return line;
    }

    std::unique_ptr<Channels> channels = std::make_unique_for_overwrite<Channels>();
    std::string log;
    CommandId id = 0;
    Epoch epoch = 0;
    StandIn stand_in{*channels, [this](const std::string &text) { log += text + "\n"; }};
};

geometry::Pose counting(double factor) {
    geometry::Pose pose;
    for (int axis = 0; axis < geometry::AXIS_COUNT; ++axis) {
        pose[axis] = factor * (axis + 1);
    }
    return pose;
}

TEST_F(LoggerTest, MovesHaveTheNamesThatTestsUse) {
    configure();
    move(line(counting(1), true, 0, 2));
    EXPECT_EQ(said(),
              "SET_LINE x=1, y=2, z=3, a=4, b=5, c=6, u=7, v=8, w=9, id=2, motion_type=1, vel=1.66296, "
              "ini_maxvel=1.66296, acc=415.74, turn=-1\n");
    move(line(counting(0.1), false, 1.0 / 60, 3));
    EXPECT_EQ(said(), "SET_LINE x=0.1, y=0.2, z=0.3, a=0.4, b=0.5, c=0.6, u=0.7, v=0.8, w=0.9, id=3, "
                      "motion_type=2, vel=0.0166667, ini_maxvel=1.66296, acc=415.74, turn=-1\n");
}

TEST_F(LoggerTest, SettingsAreLoggedWhenCompleteAndLaterChangesAtOnce) {
    set(Parameter::JOINT_MAX_LIMIT, 0, 40);
    EXPECT_EQ(said(), "");
    send(SetNumJoints{1});
    const std::string all = said();
    EXPECT_TRUE(all.starts_with("SET_NUM_JOINTS 1\nSET_NUM_SPINDLES 1\n")) << all;
    EXPECT_NE(all.find("SET_JOINT_POSITION_LIMITS joint=0, min=-1e+99, max=40\n"), std::string::npos) << all;
    EXPECT_NE(all.find("SET_SPINDLE_PARAMS, 1.00e+99, 0.00e+00, -1.00e+99, 0.00e+00\n"), std::string::npos)
        << all;
    set(Parameter::JOINT_MAX_LIMIT, 0, 30);
    EXPECT_EQ(said(), "SET_JOINT_MAX_LIMIT index=0, value=30\n");
}

TEST_F(LoggerTest, CommandsKeepTheirOrder) {
    configure();
    move(line(counting(1), true, 0, 1));
    send(SpindleOn{0, 234});
    move(line(counting(2), true, 0, 2));
    send(SpindleOff{0});
    const std::string all = said();
    const auto on = all.find("SPINDLE_ON speed=234.000000, css_factor=0.000000, xoffset=0.000000\n"),
               second = all.find("id=2"), off = all.find("SPINDLE_OFF\n");
    EXPECT_LT(all.find("id=1"), on);
    EXPECT_LT(on, second);
    EXPECT_LT(second, off);
}

TEST_F(LoggerTest, AnAbortIsLoggedForEachJogAndRejectsEarlierCommands) {
    configure();
    move(line(counting(1), true, 0, 1));
    epoch = 1;
    send(Abort{1});
    const std::string all = said();
    EXPECT_NE(all.find("JOG_ABORT joint=0\n"), std::string::npos);
    EXPECT_TRUE(all.ends_with("JOG_ABORT joint=15\nABORT\n")) << all;
    channels->path.push({++id, 0, line(counting(2), true, 0, 2)});
    EXPECT_EQ(said(), "") << "of an older epoch";
    Answer answer;
    bool isStale = false;
    while (channels->planner_answers.pop(answer)) {
        isStale = answer.kind == AnswerKind::STALE;
    }
    EXPECT_TRUE(isStale);
}

}  // namespace
}  // namespace mw::motion
