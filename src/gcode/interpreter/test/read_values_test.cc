// SPDX-License-Identifier: GPL-2.0-or-later
// Values that programs and scripts read, and texts of comments, without an executor.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/attributes.hh"
#include "gcode/interpreter/codes/comments.hh"
#include "gcode/interpreter/codes/kept_parameters.hh"
#include "gcode/interpreter/test/code_rig.hh"

namespace mw::gcode::detail {
namespace {

struct Attributes : test::CodeRig {
    Attributes() {
        place = {12, 34, 1};
        settings.is_task = true;
    }
    AttributeSources sources() { return {state, returned, levels, parts, 2}; }
    std::optional<ScriptValue> get(std::string_view name) { return attribute(name, sources()); }
    bool set(std::string_view name, const ScriptValue &value) {
        return set_attribute(name, value, sources()).has_value();
    }

    ReturnValue returned;
    ScriptLevels levels;
};

double number(const std::optional<ScriptValue> &value) {
    if (!value) {
        return std::nan("");
    }
    return std::visit(
        [](const auto &v) -> double {
            if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::string>) {
                return std::nan("");
            } else {
                return static_cast<double>(v);
            }
        },
        *value);
}

TEST(Attributes, EachNameCanBeReadAndStandsOnce) {
    Attributes values;
    std::set<std::string_view> seen;
    for (const std::string_view name : attribute_names()) {
        EXPECT_TRUE(seen.insert(name).second) << name;
        EXPECT_TRUE(values.get(name)) << name;
    }
    EXPECT_GT(seen.size(), 80u);
    EXPECT_FALSE(values.get("no_such_name"));
    EXPECT_FALSE(values.get(""));
    EXPECT_FALSE(values.set("no_such_name", 1.0));
}

TEST(Attributes, WhatIsSetIsReadBackAndNothingElseChanges) {
    int writable = 0;
    for (const std::string_view name : attribute_names()) {
        Attributes values, untouched;
        if (!values.set(name, 1.0)) {
            EXPECT_TRUE(values.state == untouched.state) << name;
            continue;
        }
        ++writable;
        const bool bounded = name == "active_spindle";  // the mill has one spindle, number 0
        EXPECT_EQ(number(values.get(name)), bounded ? 0 : 1) << name;
        for (const std::string_view other : attribute_names()) {
            if (other != name && !other.starts_with("program_")) {
                EXPECT_EQ(number(values.get(other)), number(untouched.get(other))) << name << " " << other;
            }
        }
    }
    EXPECT_GT(writable, 30);
}

TEST(Attributes, NumbersAreThoseThatScriptsExpect) {
    Attributes values;
    values.state.units = LengthUnits::INCH;
    values.state.plane = Plane::XZ;
    values.state.comp.turn_on(CompSide::LEFT, G(41), 1.0, 0);
    values.state.spindles[0].direction = -1;
    EXPECT_EQ(number(values.get("length_units")), 1);
    EXPECT_EQ(number(values.get("plane")), 3);
    EXPECT_EQ(number(values.get("cutter_comp_side")), 2);
    EXPECT_EQ(number(values.get("spindle_turning")), 3);
    EXPECT_EQ(number(values.get("sequence_number")), 12);
    EXPECT_EQ(number(values.get("remap_level")), 2);
    EXPECT_EQ(number(values.get("task")), 1);
    values.state.position[geometry::AXIS_B] = 45;
    EXPECT_EQ(number(values.get("BB_current")), 45);
}

TEST(Attributes, OnlyFiniteNumbersAreTaken) {
    Attributes values;
    EXPECT_FALSE(values.set("feed_rate", std::string("fast")));
    EXPECT_FALSE(values.set("feed_rate", std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(values.set("feed_rate", std::numeric_limits<double>::infinity()));
    EXPECT_EQ(values.state.feed, 0);
    EXPECT_TRUE(values.set("feed_rate", std::int64_t{3}));
    EXPECT_TRUE(values.set("mist", true));
    EXPECT_EQ(values.state.feed, 3);
    EXPECT_TRUE(values.state.isMist);
    EXPECT_TRUE(values.set("motion_mode", 1e300));
    EXPECT_EQ(letter_of(values.state.motion), 'g') << "bounded, not undefined";
}

struct Kept : test::CodeRig {
    Kept() {
        place = {12, 34, 3};
        settings.is_task = true;
    }
    KeptSources sources() { return {state, returned, parts, position, 2}; }

    ReturnValue returned{5, true};
    Pose position;
};

TEST(KeptParameters, EachNameHasAValueAndNoOtherHas) {
    Kept kept;
    const std::vector<std::string> names = kept_names();
    EXPECT_TRUE(std::ranges::is_sorted(names));
    EXPECT_EQ(names.size(), 42u + 18u);
    for (const std::string &name : names) {
        EXPECT_TRUE(isKeptName(name)) << name;
        EXPECT_TRUE(kept_value(name, kept.sources())) << name;
    }
    for (const char *name : {"_mine", "_", "_abs_", "_abs_q", "feed", "_xx"}) {
        EXPECT_FALSE(isKeptName(name)) << name;
        EXPECT_FALSE(kept_value(name, kept.sources())) << name;
    }
}

TEST(KeptParameters, FollowTheStateAndWhatIsAroundTheBlock) {
    Kept kept;
    kept.state.units = LengthUnits::INCH;
    kept.state.g5x_index = 7;
    kept.state.feed = 100;
    EXPECT_EQ(kept_value("_imperial", kept.sources()), 1);
    EXPECT_EQ(kept_value("_metric", kept.sources()), 0);
    EXPECT_EQ(kept_value("_metric_machine", kept.sources()), 1);
    EXPECT_EQ(kept_value("_coord_system", kept.sources()), 591);
    EXPECT_EQ(kept_value("_feed", kept.sources()), 100);
    EXPECT_EQ(kept_value("_line", kept.sources()), 12);
    EXPECT_EQ(kept_value("_call_level", kept.sources()), 3);
    EXPECT_EQ(kept_value("_remap_level", kept.sources()), 2);
    EXPECT_EQ(kept_value("_value", kept.sources()), 5);
    EXPECT_EQ(kept_value("_value_returned", kept.sources()), 1);
    const struct {
        Plane plane;
        double code;
    } planes[] = {{Plane::XY, 170}, {Plane::XZ, 180}, {Plane::YZ, 190},
                  {Plane::UV, 171}, {Plane::UW, 181}, {Plane::VW, 191}};
    for (const auto &one : planes) {
        kept.state.plane = one.plane;
        EXPECT_EQ(kept_value("_plane", kept.sources()), one.code);
    }
}

TEST(KeptParameters, PositionsAreOfTheProgramAndOfTheMachine) {
    Kept kept;
    kept.position[geometry::AXIS_X] = 1;
    kept.position[geometry::AXIS_Y] = 2;
    kept.state.frame.g5x[geometry::AXIS_X] = 10;
    kept.state.frame.g92[geometry::AXIS_Y] = 20;
    kept.state.frame.rotation_deg = 90;
    EXPECT_EQ(kept_value("_x", kept.sources()), 1);
    EXPECT_EQ(kept_value(P_POSITION + 1, kept.sources()), 2);
    EXPECT_NEAR(*kept_value("_abs_x", kept.sources()), 10 - 22, 1e-12);
    EXPECT_NEAR(*kept_value("_abs_y", kept.sources()), 1, 1e-12);
    EXPECT_NEAR(kept_value(P_MACHINE_POSITION, kept.sources()), 10 - 22, 1e-12);
    kept.state.tool.diameter = 6;
    EXPECT_EQ(kept_value(P_TOOL_DIAMETER, kept.sources()), 6);
    EXPECT_EQ(kept_value(P_TOOL_NUMBER, kept.sources()), 0);
}

// ------------------------------------------------------------------------------------------------ comments

class NothingKept final : public BuiltIns {
  public:
    bool isBuiltInName(std::string_view) const override { return false; }
    std::optional<double> built_in(std::string_view) const override { return std::nullopt; }
    double built_in(int) const override { return 0; }
};

/// Result of a comment as text; "error: ..." when it fails.
class Comments final : public Canon {
  public:
    std::string of(std::string_view comment) {
        said.clear();
        fault.clear();
        if (!run_comment(comment, 5, {evaluator, names}, queue, fault)) {
            return "error: " + fault.message;
        }
        queue.flush(*this);
        return said;
    }
    void begin_block(const BlockRef &) override {}
    void take(const CanonCall &call) override {
        if (const auto *plain = std::get_if<ProgramComment>(&call)) {
            said += "comment " + plain->text + ";";
        } else if (const auto *message = std::get_if<OperatorMessage>(&call)) {
            said += "message " + message->text + ";";
        } else if (const auto *print = std::get_if<PrintLine>(&call)) {
            said += "print " + print->text + ";";
        } else if (const auto *log = std::get_if<LogLine>(&call)) {
            said += "log " + log->text + ";";
        } else if (const auto *open = std::get_if<OpenLog>(&call)) {
            said += "open " + open->path + (open->appending ? " append;" : ";");
        } else if (std::holds_alternative<CloseLog>(call)) {
            said += "close;";
        } else if (const auto *probes = std::get_if<LogProbes>(&call)) {
            said += "probes " + probes->path + ";";
        } else {
            said += "?;";
        }
    }

    std::string said;
    Names names;
    Parameters parameters;
    Fault fault;
    NothingKept kept;
    Evaluator evaluator{parameters, names, kept, fault};
    CanonQueue queue;
};

TEST(Comments, AreHandedOnAsWhatTheyAskFor) {
    Comments comments;
    EXPECT_EQ(comments.of("  just text"), "comment just text;");
    EXPECT_EQ(comments.of("   "), "");
    EXPECT_EQ(comments.of("MSG, hello #1"), "message  hello #1;") << "messages show what is written";
    EXPECT_EQ(comments.of("m s g,x"), "message x;");
    EXPECT_EQ(comments.of("print,x"), "print x;");
    EXPECT_EQ(comments.of("LOG,x"), "log x;");
    EXPECT_EQ(comments.of("logopen, a.txt "), "open a.txt;");
    EXPECT_EQ(comments.of("logappend,a.txt"), "open a.txt append;");
    EXPECT_EQ(comments.of("logclose"), "close;");
    EXPECT_EQ(comments.of("PROBEOPEN p.txt"), "comment PROBEOPEN p.txt;probes p.txt;");
    EXPECT_EQ(comments.of("probeclose"), "comment probeclose;probes ;");
    EXPECT_EQ(comments.of("print x"), "comment print x;") << "a keyword needs its comma";
}

TEST(Comments, ShowParametersInTheFormatLastAskedFor) {
    Comments comments;
    comments.parameters.set(1, 2.5);
    comments.parameters.set_named(comments.names.intern("ab"), false, -1.25);
    EXPECT_EQ(comments.of("print,#1 #<A b>"), "print 2.500000 -1.250000;");
    EXPECT_EQ(comments.of("print,%.1f#1 %d#1 %f#<ab> %.0f#<ab>"), "print 2.5 2 -1.2500 -1;");
    EXPECT_EQ(comments.of("print,#<none> #9999"), "print ###### ######;");
    EXPECT_EQ(comments.of("print,# 1 100%"), "print # 1 100%;");
}

TEST(Comments, DebugIsShownUnlessItIsSwitchedOff) {
    Comments comments;
    comments.parameters.set(1, 3);
    EXPECT_EQ(comments.of("debug,%d#1"), "message 3;");
    comments.parameters.set(P_DEBUG_SHOWN, 0);
    EXPECT_EQ(comments.of("debug,%d#1"), "");
}

TEST(Comments, FailWithTheirColumn) {
    Comments comments;
    comments.parameters.set(1, 3);
    EXPECT_EQ(comments.of("abort,tool %d#1 broken"), "error: tool 3 broken");
    EXPECT_EQ(comments.fault.column, 5u);
    EXPECT_EQ(comments.of("logopen,"), "error: (logopen,...) and (logappend,...) need the name of a file");
    EXPECT_EQ(comments.of("probeopen"), "error: (probeopen FILE) needs the name of a file");
}

}  // namespace
}  // namespace mw::gcode::detail
