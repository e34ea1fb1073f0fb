// SPDX-License-Identifier: GPL-2.0-or-later
// Each canon call: its name, its printed line, and its path through the queue and the frame.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "gcode/canon/call_text.hh"
#include "gcode/canon/canon_queue.hh"
#include "gcode/canon/machine_frame.hh"
#include "gcode/canon/print_canon.hh"
#include "gcode/syntax/names.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode {
namespace {

Pose pose(double x, double y, double z) {
    Pose out;
    out[geometry::AXIS_X] = x;
    out[geometry::AXIS_Y] = y;
    out[geometry::AXIS_Z] = z;
    return out;
}

ToolEntry tool(int number) {
    ToolEntry out;
    out.toolno = number;
    out.offset = pose(0, 0, 7);
    out.orientation = 2;
    out.comment = "a comment long enough to be stored outside of the entry";
    return out;
}

/// A call and its text from rs274; empty: not printed.
struct Printed {
    CanonCall call;
    std::string text;
};

/// Calls with all their variants.
std::vector<Printed> move_calls() {
    return {
        {OnReset{}, "ON_RESET()"},
        {UseLengthUnits{LengthUnits::INCH}, "USE_LENGTH_UNITS(CANON_UNITS_INCHES)"},
        {UseLengthUnits{LengthUnits::MM}, "USE_LENGTH_UNITS(CANON_UNITS_MM)"},
        {SelectPlane{Plane::XY}, "SELECT_PLANE(CANON_PLANE_XY)"},
        {SelectPlane{Plane::YZ}, "SELECT_PLANE(CANON_PLANE_YZ)"},
        {SelectPlane{Plane::XZ}, "SELECT_PLANE(CANON_PLANE_XZ)"},
        {SelectPlane{Plane::UW}, "SELECT_PLANE(CANON_PLANE_UNKNOWN)"},
        {SetG5xOffset{2, pose(1, 2, 3)}, "SET_G5X_OFFSET(2, 1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)"},
        {SetG92Offset{pose(1, 2, 3)}, "SET_G92_OFFSET(1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)"},
        {SetXyRotation{45}, "SET_XY_ROTATION(45.0000)"},
        {UseToolLengthOffset{pose(0, 0, 5)},
         "USE_TOOL_LENGTH_OFFSET(0.0000 0.0000 5.0000, 0.0000 0.0000 0.0000, 0.0000 0.0000 0.0000)"},
        {SetFeedReference{}, "SET_FEED_REFERENCE(CANON_XYZ)"},
        {SetFeedRate{120.5}, "SET_FEED_RATE(120.5000)"},
        {SetFeedMode{1, FeedMode::UNITS_PER_REVOLUTION}, "SET_FEED_MODE(1, 1)"},
        {SetFeedMode{0, FeedMode::INVERSE_TIME}, "SET_FEED_MODE(0, 0)"},
        {SetMotionControlMode{geometry::PathMode::EXACT_STOP, 0},
         "SET_MOTION_CONTROL_MODE(CANON_EXACT_STOP)"},
        {SetMotionControlMode{geometry::PathMode::EXACT_PATH, 0},
         "SET_MOTION_CONTROL_MODE(CANON_EXACT_PATH)"},
        {SetMotionControlMode{geometry::PathMode::BLEND, 0.05},
         "SET_MOTION_CONTROL_MODE(CANON_CONTINUOUS, 0.050000)"},
        {SetNaivecamTolerance{0.02}, "SET_NAIVECAM_TOLERANCE(0.0200)"},
        {SetPlannerMode{1, 0.5}, "SET_PLANNER_MODE(type=1, peak_scale=0.500000)"},
        {StraightTraverse{pose(1, 2, 3)},
         "STRAIGHT_TRAVERSE(1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)"},
        {StraightFeed{pose(1, 2, 4)}, "STRAIGHT_FEED(1.0000, 2.0000, 4.0000, 0.0000, 0.0000, 0.0000)"},
        {ArcFeed{3, 2, 2, 2, -1, 4, pose(3, 2, 4)},
         "ARC_FEED(3.0000, 2.0000, 2.0000, 2.0000, -1, 4.0000, 0.0000, 0.0000, 0.0000)"},
        {NurbsFeed{{{3, 2}, {4, 2}, {5, 2}}, 3, pose(5, 2, 4)}, "NURBS_FEED(3, ...)"},
        {StraightProbe{pose(1, 2, 3), ProbeKind::AWAY},
         "TURN_PROBE_ON()\nSTRAIGHT_PROBE(1.0000, 2.0000, 3.0000, 0.0000, 0.0000, 0.0000)\nTURN_PROBE_OFF()"},
        {RigidTap{1, 2, -3, 1.5}, "RIGID_TAP(1.0000, 2.0000, -3.0000)"},
        {Dwell{0.25}, "DWELL(0.2500)"},
        {StartSpeedFeedSynch{0, 1.5, true}, "START_SPEED_FEED_SYNC(1.500000,1)"},
        {StopSpeedFeedSynch{}, "STOP_SPEED_FEED_SYNCH()"},
    };
}

std::vector<Printed> action_calls() {
    return {
        {SetSpindleMode{0, 3000}, "SET_SPINDLE_MODE(0 3000.0000)"},
        {SetSpindleSpeed{1, 1200}, "SET_SPINDLE_SPEED(1, 1200.0000)"},
        {StartSpindle{1, true, false}, "START_SPINDLE_CLOCKWISE(1)"},
        {StartSpindle{0, false, true}, "START_SPINDLE_COUNTERCLOCKWISE(0)"},
        {StopSpindle{1}, "STOP_SPINDLE_TURNING(1)"},
        {OrientSpindle{0, 90, 2}, "ORIENT_SPINDLE(0, 90.0000, 2)"},
        {WaitOrientComplete{0, 5}, "SPINDLE.0.WAIT_ORIENT_COMPLETE(5.0000)"},
        {SelectTool{7}, "SELECT_TOOL(7)"},
        {ChangeTool{}, "CHANGE_TOOL()"},
        {ChangeToolNumber{7}, "CHANGE_TOOL_NUMBER(7)"},
        {SetToolTableEntry{3, tool(7)},
         "SET_TOOL_TABLE_ENTRY(3, 7, 0.0000 0.0000 7.0000 0.0000 0.0000 0.0000 0.0000 0.0000 0.0000, 0.0000, "
         "0.0000, 2)"},
        {ReloadTools{}, "RELOAD_TOOLDATA()"},
        {SwitchMist{true}, "MIST_ON()"},
        {SwitchMist{false}, "MIST_OFF()"},
        {SwitchFlood{true}, "FLOOD_ON()"},
        {SwitchFlood{false}, "FLOOD_OFF()"},
        {SwitchFeedOverride{true}, "ENABLE_FEED_OVERRIDE()"},
        {SwitchFeedOverride{false}, "DISABLE_FEED_OVERRIDE()"},
        {SwitchSpeedOverride{1, true}, "ENABLE_SPEED_OVERRIDE(1)"},
        {SwitchSpeedOverride{1, false}, "DISABLE_SPEED_OVERRIDE(1)"},
        {SwitchFeedHold{true}, "ENABLE_FEED_HOLD()"},
        {SwitchFeedHold{false}, "DISABLE_FEED_HOLD()"},
        {SwitchAdaptiveFeed{true}, "ENABLE_ADAPTIVE_FEED()"},
        {SwitchAdaptiveFeed{false}, "DISABLE_ADAPTIVE_FEED()"},
        {SetDigitalOutput{3, true, true}, "SET_MOTION_OUTPUT_BIT(3)"},
        {SetDigitalOutput{3, false, true}, "CLEAR_MOTION_OUTPUT_BIT(3)"},
        {SetDigitalOutput{3, true, false}, "SET_AUX_OUTPUT_BIT(3)"},
        {SetDigitalOutput{3, false, false}, "CLEAR_AUX_OUTPUT_BIT(3)"},
        {SetAnalogOutput{3, 0.5, true}, "SET_MOTION_OUTPUT_VALUE(3,0.500000)"},
        {SetAnalogOutput{3, 0.5, false}, "SET_AUX_OUTPUT_VALUE(3,0.500000)"},
        {WaitInput{1, false, WaitKind::RISE, 2}, ""},
        {ProgramStop{false}, "PROGRAM_STOP()"},
        {ProgramStop{true}, "OPTIONAL_PROGRAM_STOP()"},
        {ProgramEnd{}, "PROGRAM_END()"},
        {PalletShuttle{}, "PALLET_SHUTTLE()"},
        {Finish{}, "FINISH()"},
        {UserCode{101, 1, -1}, "USER_DEFINED_FUNCTION(101, 1.0000, -1.0000)"},
        {ProgramComment{"as written"}, "COMMENT(\"as written\")"},
        {OperatorMessage{"for people"}, "MESSAGE(\"for people\")"},
        {PrintLine{"for scripts"}, "for scripts"},
        {OpenLog{"a.log", false}, "LOGOPEN(\"a.log\")"},
        {OpenLog{"a.log", true}, "LOGAPPEND(\"a.log\")"},
        {LogLine{"1 2 3"}, "LOG(\"1 2 3\")"},
        {CloseLog{}, "LOGCLOSE()"},
        {LogProbes{"probe.txt"}, ""},
        {CanonError{"no such spindle"}, "CANON_ERROR(no such spindle)"},
    };
}

/// At least one of each call.
const std::vector<Printed> &all_calls() {
    static const std::vector<Printed> CALLS = [] {
        std::vector<Printed> calls = move_calls(), actions = action_calls();
        for (Printed &one : actions) {
            calls.push_back(std::move(one));
        }
        return calls;
    }();
    return CALLS;
}

/// Text that a PrintCanon writes while `run` uses it.
template <class Run>
std::string printed(Run run) {
    char *text = nullptr;
    std::size_t size = 0;
    std::FILE *file = ::open_memstream(&text, &size);
    {
        PrintCanon canon(file);
        run(canon);
    }
    std::fclose(file);
    const std::string out(text, size);
    std::free(text);
    return out;
}

/// The text without counter and block number.
std::string calls_only(const std::string &lines) {
    std::istringstream in(lines);
    std::string out;
    for (std::string line; std::getline(in, line);) {
        const std::size_t head = line.find("N..... ");
        out += (out.empty() ? "" : "\n") + (head == std::string::npos ? line : line.substr(head + 7));
    }
    return out;
}

template <std::size_t... indices>
std::vector<std::string> declared_names(std::index_sequence<indices...>) {
    std::vector<std::string> names;
    const auto add = [&]<class Call>(const Call *) {
        if constexpr (requires { Call::CHOICES; }) {
            static_assert(Call::NAMES.size() == std::size_t{1} << std::tuple_size_v<decltype(Call::CHOICES)>,
                          "one name for each choice");
            names.insert(names.end(), Call::NAMES.begin(), Call::NAMES.end());
        } else {
            static_assert(!Call::NAME.empty(), "a call has a name");
            names.emplace_back(Call::NAME);
        }
    };
    (add(static_cast<const std::variant_alternative_t<indices, CanonVariant> *>(nullptr)), ...);
    return names;
}

TEST(CanonCalls, HaveANameOfTheirOwnEach) {
    const auto names = declared_names(std::make_index_sequence<std::variant_size_v<CanonVariant>>{});
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
}

TEST(CanonCalls, AreAllInTheTableOfThisTest) {
    std::set<std::size_t> seen;
    for (const Printed &one : all_calls()) {
        seen.insert(one.call.index());
    }
    EXPECT_EQ(seen.size(), std::variant_size_v<CanonVariant>);
}

TEST(PrintCanon, WritesEachCallInItsForm) {
    for (const Printed &one : all_calls()) {
        EXPECT_EQ(calls_only(printed([&](Canon &canon) { canon.take(one.call); })), one.text);
    }
}

TEST(PrintCanon, CountsLinesAndNamesBlocksThatHaveANumber) {
    const std::string text = printed([](Canon &canon) {
        canon.begin_block({"a.ngc", 1, 10, 0, "N10 M7", true});
        canon.take(SwitchMist{true});
        canon.begin_block({"a.ngc", 2, 2, 0, "M9", false});
        canon.take(SwitchMist{false});
        canon.begin_block({"a.ngc", 3, 30, 0, "N30", true});
        canon.take(Finish{});
    });
    EXPECT_EQ(text, "    1 N10    MIST_ON()\n"
                    "    2 N..... MIST_OFF()\n"
                    "    3 N..... FINISH()\n");
}

TEST(CanonQueue, HandsOnEachCallAsItCame) {
    detail::CanonQueue queue;
    const std::string direct = printed([&](Canon &canon) {
        for (const Printed &one : all_calls()) {
            canon.take(one.call);
            queue.take(one.call);
        }
    });
    EXPECT_EQ(queue.size(), all_calls().size());
    EXPECT_EQ(printed([&](Canon &canon) { queue.flush(canon); }), direct);
    EXPECT_TRUE(queue.empty());
}

/// Records blocks and calls by lines and names.
class Notes final : public Canon {
  public:
    std::vector<std::string> notes;

    void begin_block(const BlockRef &block) override {
        notes.push_back("line " + std::to_string(block.line) + ": " + std::string(block.text));
    }
    void take(const CanonCall &call) override {
        std::visit([this](const AlternativeOf<CanonCall> auto &one) { notes.emplace_back(name_of(one)); },
                   call);
    }
};

TEST(CanonQueue, AnnouncesABlockOnceAndOnlyWithACall) {
    detail::Names names;
    const detail::Program program("a.ngc", "M7\n(nothing)\nM8\n", names);
    detail::CanonQueue queue;
    queue.enter_block(&program, 1, 1, false, 0);
    queue.take(SwitchMist{true});
    queue.take(Dwell{1});
    queue.enter_block(&program, 2, 2, false, 0);
    queue.enter_block(&program, 3, 3, false, 0);
    queue.take(SwitchFlood{true});
    Notes out;
    queue.flush(out);
    EXPECT_EQ(out.notes,
              (std::vector<std::string>{"line 1: M7", "MIST_ON", "DWELL", "line 3: M8", "FLOOD_ON"}));
}

TEST(CanonQueue, DropsTheCallsOfABlockThatFailedAndAnnouncesTheBlockAnew) {
    detail::Names names;
    const detail::Program program("a.ngc", "M7\nM8\n", names);
    detail::CanonQueue queue;
    queue.enter_block(&program, 1, 1, false, 0);
    queue.take(SwitchMist{true});
    queue.begin_undo();
    queue.enter_block(&program, 2, 2, false, 0);
    queue.take(SwitchFlood{true});
    queue.rollback();
    queue.take(SwitchFlood{false});
    Notes out;
    queue.flush(out);
    EXPECT_EQ(out.notes, (std::vector<std::string>{"line 1: M7", "MIST_ON", "line 2: M8", "FLOOD_OFF"}));
}

TEST(CanonQueue, HoldsCallsBackBehindAPartialFlushAndLetsThemChange) {
    detail::Names names;
    const detail::Program program("a.ngc", "G1 X1\nG1 X2\nM7\n", names);
    detail::CanonQueue queue;
    for (int line = 1; line <= 2; ++line) {
        queue.enter_block(&program, line, line, false, 0);
        queue.take(StraightFeed{pose(line, 0, 0)});
    }
    queue.enter_block(&program, 3, 3, false, 0);
    queue.take(SwitchMist{true});
    Notes out;
    queue.flush(out, 1);
    EXPECT_EQ(out.notes, (std::vector<std::string>{"line 1: G1 X1", "STRAIGHT_FEED", "line 2: G1 X2"}));
    ASSERT_EQ(queue.size(), 2u);
    queue.move_ends(0, {geometry::AXIS_X, 5}, {geometry::AXIS_Y, 6});
    const std::string rest = printed([&](Canon &canon) { queue.flush(canon); });
    EXPECT_EQ(calls_only(rest), "STRAIGHT_FEED(5.0000, 6.0000, 0.0000, 0.0000, 0.0000, 0.0000)\nMIST_ON()");
}

TEST(CanonQueue, TakesBackTheEndsThatAFailedBlockHasMovedAndWhatItMovedOfItsOwn) {
    detail::CanonQueue queue;
    queue.take(StraightFeed{pose(1, 0, 0)});
    queue.begin_undo();
    queue.take(ArcFeed{2, 0, 0, 0, 1, 0, pose(2, 0, 0)});
    queue.move_ends(0, {geometry::AXIS_X, 5}, {geometry::AXIS_Y, 6});
    queue.move_ends(1, {geometry::AXIS_X, 7}, {geometry::AXIS_Y, 8});
    queue.rollback();
    EXPECT_EQ(calls_only(printed([&](Canon &canon) { queue.flush(canon); })),
              "STRAIGHT_FEED(1.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.0000)");
}

TEST(CanonQueue, KeepsMovedEndsOnceTheBlockHasSucceeded) {
    detail::CanonQueue queue;
    queue.take(StraightFeed{pose(1, 0, 0)});
    queue.begin_undo();
    queue.move_ends(0, {geometry::AXIS_X, 5}, {geometry::AXIS_Y, 6});
    queue.commit();
    queue.begin_undo();
    queue.take(StraightFeed{pose(9, 9, 9)});
    queue.rollback();
    EXPECT_EQ(calls_only(printed([&](Canon &canon) { queue.flush(canon); })),
              "STRAIGHT_FEED(5.0000, 6.0000, 0.0000, 0.0000, 0.0000, 0.0000)");
}

/// Records all machine calls.
class Machine final : public MachineCanon {
  public:
    std::vector<MachineCall> calls;

    void begin_block(const BlockRef &) override {}
    void take(const MachineCall &call) override { calls.push_back(call); }
};

template <class... Calls>
std::vector<std::size_t> kinds() {
    return {MachineCall(Calls{}).index()...};
}

/// The machine call for each call; nothing for calls whose effect is in the coordinates and settings of later
/// calls.
std::vector<std::size_t> machine_kinds(const CanonCall &call) {
    return std::visit(
        Overloaded{
            [](const OneOf<StraightFeed, StraightTraverse> auto &) { return kinds<LineMove>(); },
            [](const ArcFeed &) { return kinds<ArcMove>(); },
            [](const StraightProbe &) { return kinds<ProbeMove>(); },
            [](const RigidTap &) { return kinds<TapMove>(); },
            [](const OneOf<SetG5xOffset, SetG92Offset, SetXyRotation> auto &) { return kinds<UseOffsets>(); },
            [](const UseToolLengthOffset &) { return kinds<UseToolOffset>(); },
            [](const SetPlannerMode &) { return kinds<UsePlanner>(); },
            [](const SetSpindleSpeed &) { return kinds<UseSpindleSpeed>(); },
            [](const OneOf<OnReset, UseLengthUnits, SelectPlane, SetFeedReference, SetFeedRate, SetFeedMode,
                           SetMotionControlMode, SetNaivecamTolerance, StartSpeedFeedSynch,
                           StopSpeedFeedSynch> auto &) { return kinds<>(); },
            [](const NurbsFeed &) { return kinds<LineMove>(); },
            []<AlternativeOf<MachineCall> Call>(const Call &) { return kinds<Call>(); },
        },
        call);
}

TEST(MachineFrame, MapsEachCallToWhatTheMachineDoes) {
    for (const Printed &one : all_calls()) {
        Machine machine;
        MachineFrame frame(machine, LengthUnits::MM);
        frame.set_position(pose(1, 2, 4));
        frame.take(one.call);
        std::vector<std::size_t> found;
        for (const MachineCall &call : machine.calls) {
            found.push_back(call.index());
        }
        if (std::holds_alternative<NurbsFeed>(one.call)) {
            EXPECT_FALSE(found.empty()) << one.text;  // any number of moves is permitted
        } else {
            EXPECT_EQ(found, machine_kinds(one.call)) << one.text;
        }
    }
}

TEST(MachineFrame, TurnsInchesOfAProgramIntoMillimetresOfTheMachine) {
    Machine machine;
    MachineFrame frame(machine, LengthUnits::MM);
    frame.take(UseLengthUnits{LengthUnits::INCH});
    frame.take(SetG5xOffset{1, pose(1, 0, 0)});
    frame.take(UseToolLengthOffset{pose(0, 0, 2)});
    frame.take(SetFeedRate{60});
    frame.take(SetMotionControlMode{geometry::PathMode::BLEND, 0.01});
    machine.calls.clear();
    frame.take(StraightFeed{pose(1, 0, 0)});
    frame.take(SetSpindleSpeed{0, 300});
    ASSERT_EQ(machine.calls.size(), 2u);
    constexpr double EXACT = 1e-9;  // the rounding error of a few products
    const auto &move = std::get<LineMove>(machine.calls[0]);
    EXPECT_NEAR(move.end[geometry::AXIS_X], 50.8, EXACT);
    EXPECT_NEAR(move.end[geometry::AXIS_Z], 50.8, EXACT);
    EXPECT_NEAR(move.settings.feed, 25.4, EXACT);
    EXPECT_NEAR(move.settings.tolerance, 0.254, EXACT);
    EXPECT_NEAR(std::get<UseSpindleSpeed>(machine.calls[1]).surface_unit, 12 * 25.4, EXACT);
}

// The example of docs/developer/extending/canon_call.md; the test below compares both.
/// M180: the laser's power.
struct SetLaserPower {
    int head = 0;
    double power = 0;  ///< fraction of full power, 0 to 1

    static constexpr std::string_view NAME = "SET_LASER_POWER";
    static constexpr std::tuple FIELDS{&SetLaserPower::head, &SetLaserPower::power};
};

TEST(CanonCalls, OfTheDocumentedExamplePrintThemselves) {
    std::string text;
    append_call(text, SetLaserPower{1, 0.5});
    EXPECT_EQ(text, "SET_LASER_POWER(1, 0.5000)");
    static_assert(RegularCall<SetLaserPower>);
    static_assert(!AlternativeOf<SetLaserPower, CanonCall>);
}

TEST(CanonCalls, OfTheDocumentedExampleAreTheseOfThisTest) {
    const auto read = [](const std::string &path) {
        std::ifstream in(std::string(MW_SOURCE_DIR) + path);
        std::ostringstream out;
        out << in.rdbuf();
        return out.str();
    };
    const std::string document = read("/docs/developer/extending/canon_call.md"),
                      test = read("/src/gcode/interpreter/test/canon_call_test.cc");
    const std::size_t begin = document.find("/// M180"), end = document.find("};\n", begin);
    ASSERT_NE(begin, std::string::npos);
    ASSERT_NE(end, std::string::npos);
    EXPECT_NE(test.find(document.substr(begin, end - begin)), std::string::npos);
}

}  // namespace
}  // namespace mw::gcode
