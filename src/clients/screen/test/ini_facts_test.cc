// SPDX-License-Identifier: GPL-2.0-or-later
// Tests the data about the machine for a screen, from its INI file (J1).
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include "base/atomic_file.hh"
#include "clients/screen/assembly/ini_facts.hh"
#include "clients/screen/files/filter.hh"
#include "clients/screen/path/path_readers.hh"

namespace mw::screen {
namespace {

namespace fs = std::filesystem;

std::vector<std::pair<double, bool>> values(const std::vector<Increment> &increments) {
    std::vector<std::pair<double, bool>> out;
    for (const auto &one : increments) {
        out.emplace_back(one.value, one.isAngular);
    }
    return out;
}

TEST(UiFacts, IncrementsMixUnits) {
    std::vector<std::string> bad;
    const auto all = parse_increments("1 mm, .01in, 1/8 inch, 5 mil,2cm , 10um, 45 deg, 0.5", 1, bad);
    EXPECT_TRUE(bad.empty());
    ASSERT_EQ(all.size(), 8U);
    const double expected[] = {1, 0.254, 3.175, 0.127, 20, 0.01, 45, 0.5};
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_NEAR(all[i].value, expected[i], 1e-12) << all[i].text;
        EXPECT_EQ(all[i].isAngular, i == 6);
    }
    EXPECT_EQ(all[1].text, ".01in");
    EXPECT_EQ(values(parse_increments("1 .1 .01", 25.4, bad)),
              (std::vector<std::pair<double, bool>>{{1, false}, {0.1, false}, {0.01, false}}));
    EXPECT_NEAR(parse_increments("1 mm,", 25.4, bad).at(0).value, 1 / 25.4, 1e-15);
    EXPECT_TRUE(bad.empty());
    EXPECT_TRUE(parse_increments("continuous, x, 1 mile, -1, 1/0, 0, 1//2", 1, bad).empty());
    EXPECT_EQ(bad, (std::vector<std::string>{"x", "1 mile", "-1", "1/0", "0", "1//2"}));
}

class UiMachine : public testing::Test {
  protected:
    UiMachine() {
        folder_ = fs::temp_directory_path() / ("mw_ui_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }
    ~UiMachine() override { fs::remove_all(folder_); }

    /// A sample machine with additional lines in separate sections.
    std::unique_ptr<machine::LoadedConfig> load(const std::string &ini, const std::string &display = "",
                                                const std::string &more = "") {
        const fs::path path = folder_ / "machine.ini";
        std::string text = *read_file(std::string(MW_SOURCE_DIR "/configs/sim/") + ini + ".ini");
        const std::size_t place = text.find("[DISPLAY]\n") + std::string("[DISPLAY]\n").size();
        text.insert(place, display);
        std::ofstream(path) << text << more;
        auto loaded = machine::LoadedConfig::load(path.string(), sink_);
        if (loaded != nullptr) {
            loaded->machine.task.parameter_file.clear();
            loaded->machine.tool_table_file.clear();
        }
        return loaded;
    }

    fs::path folder_;
    diagnostics::Sink sink_;
};

TEST_F(UiMachine, TheMillSaysWhatItIs) {
    const auto loaded =
        load("mill_mm",
             "INCREMENTS = 1 mm, 0.1 in, junk\nCYCLE_TIME = 0.1\nMAX_LINEAR_VELOCITY = 150\n"
             "DEFAULT_SPINDLE_SPEED = 750\nMAX_SPINDLE_OVERRIDE = 1.5\nMIN_SPINDLE_OVERRIDE = 0.5\n",
             "\n[MDI_COMMAND_LIST]\nMDI_COMMAND_MACRO0 = G0 X0, Home X\nMDI_COMMAND_MACRO1 = G0 Y0\n"
             "[FILTER]\nPROGRAM_EXTENSION = .png,.gif Images\n");
    ASSERT_NE(loaded, nullptr);
    const auto facts = machine_facts(*loaded, sink_);
    EXPECT_EQ(facts.name, "Millwright mill (mm)");
    EXPECT_EQ(facts.axes, "XYZ");
    EXPECT_EQ(facts.joints, 3);
    EXPECT_EQ(facts.joint_kinds, (std::vector<std::string>{"LINEAR", "LINEAR", "LINEAR"}));
    EXPECT_TRUE(facts.isHomingForced);
    EXPECT_EQ(facts.linear_unit, "mm");
    EXPECT_EQ(facts.max_linear_velocity, 150);
    EXPECT_EQ(facts.default_linear_velocity, 50);
    EXPECT_EQ(facts.max_angular_velocity, 0);
    EXPECT_EQ(facts.max_feed_override, 2);
    ASSERT_EQ(facts.spindles.size(), 1U);
    EXPECT_EQ(facts.spindles[0].min_override, 0.5);
    EXPECT_EQ(facts.spindles[0].max_override, 1.5);
    EXPECT_EQ(facts.spindles[0].default_speed, 750);
    ASSERT_EQ(facts.increments.size(), 2U);
    EXPECT_NEAR(facts.increments[1].value, 2.54, 1e-12);
    EXPECT_EQ(facts.mdi_commands, (std::vector<std::string>{"G0 X0, Home X", "G0 Y0"}));
    EXPECT_NE(std::ranges::find(facts.program_extensions, ".gif"), facts.program_extensions.end());
    EXPECT_EQ(std::ranges::find(facts.program_extensions, "images"), facts.program_extensions.end());
    EXPECT_EQ(facts.program_prefix, fs::weakly_canonical(folder_ / "../../nc_files").string());
    EXPECT_EQ(status_period_s(loaded->ini, sink_), 0.1);
    EXPECT_EQ(sink_.count_errors(), 0);
    EXPECT_NE(sink_.all().back().str().find("junk"), std::string::npos);
}

TEST_F(UiMachine, EachSpindleHasItsOwnLimits) {
    const auto loaded =
        load("mill_mm",
             "MIN_SPINDLE_OVERRIDE = 0.4\nMAX_SPINDLE_0_OVERRIDE = 1.2\nMIN_SPINDLE_1_OVERRIDE = 0\n"
             "MAX_SPINDLE_1_OVERRIDE = 1.6\nMIN_SPINDLE_1_SPEED = 300\nMAX_SPINDLE_1_SPEED = 9000\n"
             "DEFAULT_SPINDLE_1_SPEED = 4000\nDEFAULT_SPINDLE_SPEED = 800\n",
             "\n[SPINDLE_1]\nINCREMENT = 250\n");
    ASSERT_NE(loaded, nullptr);
    loaded->machine.num_spindles = 2;
    const auto facts = machine_facts(*loaded, sink_);
    ASSERT_EQ(facts.spindles.size(), 2U);
    EXPECT_EQ(facts.spindles[0].min_override, 0.4);
    EXPECT_EQ(facts.spindles[0].max_override, 1.2);
    EXPECT_EQ(facts.spindles[0].default_speed, 800);
    EXPECT_EQ(facts.spindles[0].increment, 100);
    EXPECT_EQ(facts.spindles[1].min_override, 0);
    EXPECT_EQ(facts.spindles[1].max_override, 1.6);
    EXPECT_EQ(facts.spindles[1].min_speed, 300);
    EXPECT_EQ(facts.spindles[1].max_speed, 9000);
    EXPECT_EQ(facts.spindles[1].default_speed, 4000);
    EXPECT_EQ(facts.spindles[1].increment, 250);
    EXPECT_EQ(sink_.all().size(), 0U);
}

TEST_F(UiMachine, JogsStartWithinWhatTheMachineCan) {
    const auto facts = [this](const char *display) {
        return machine_facts(*load("mill_mm", display), sink_);
    };
    EXPECT_EQ(facts("DEFAULT_LINEAR_VELOCITY = 20\n").default_linear_velocity, 20);
    EXPECT_TRUE(sink_.all().empty());
    const auto fast = facts("DEFAULT_LINEAR_VELOCITY = 3000\nMAX_LINEAR_VELOCITY = 6000\n");
    EXPECT_EQ(fast.max_linear_velocity, 200) << "MAX_VELOCITY of the fastest axis";
    EXPECT_EQ(fast.default_linear_velocity, 200);
    ASSERT_EQ(sink_.all().size(), 1U);
    EXPECT_NE(sink_.all()[0].str().find(
                  "[DISPLAY]DEFAULT_LINEAR_VELOCITY = 3000 exceeds the maximum jog speed of 200"),
              std::string::npos)
        << sink_.all()[0].str();
}

TEST_F(UiMachine, CycleTimeIsSecondsOrMilliseconds) {
    EXPECT_EQ(status_period_s(load("mill_mm", "CYCLE_TIME = 150\n")->ini, sink_), 0.15);
    EXPECT_EQ(status_period_s(load("mill_mm", "CYCLE_TIME = 0.001\n")->ini, sink_), 0.02);
    EXPECT_EQ(status_period_s(load("mill_mm")->ini, sink_), 0.05);
}

TEST_F(UiMachine, ARotaryAxisHasSpeedsAndSteps) {
    const auto loaded = load("mill_xyza");
    ASSERT_NE(loaded, nullptr);
    const auto facts = machine_facts(*loaded, sink_);
    EXPECT_EQ(facts.axes, "XYZA");
    EXPECT_GT(facts.max_angular_velocity, 0);
    EXPECT_GT(facts.default_angular_velocity, 0);
    EXPECT_TRUE(facts.increments.back().isAngular);
}

TEST_F(UiMachine, TheKindOfMachineAndItsGeometryAreSaid) {
    const auto facts = [this](const char *machine, const char *display) {
        return machine_facts(*load(machine, display), sink_);
    };
    EXPECT_EQ(facts("mill_mm", "").look.kind, MachineKind::MILL);
    EXPECT_EQ(facts("lathe", "").look.kind, MachineKind::LATHE);
    EXPECT_EQ(facts("lathe", "BACK_TOOL_LATHE = 1\n").look.kind, MachineKind::BACK_LATHE);
    EXPECT_EQ(facts("mill_mm", "MACHINE_TYPE_HINT = LATHE\n").look.kind, MachineKind::LATHE);
    EXPECT_EQ(facts("mill_mm", "FOAM = 1\n").look.kind, MachineKind::FOAM);
    EXPECT_NEAR(facts("mill_mm", "FOAM = 1\n").look.foam_w, 38.1, 1e-9);
    EXPECT_EQ(facts("mill_mm", "FOAM = 1\nFOAM_Z = 2\nFOAM_W = 300\n").look.foam_w, 300);
    EXPECT_TRUE(path_look(facts("mill_mm", "FOAM = 1\nFOAM_Z = 2\n")).foam.has_value());
    EXPECT_EQ(facts("mill_xyza", "GEOMETRY = AXYZ\n").look.geometry, "AXYZ");
    EXPECT_FALSE(path_look(facts("mill_xyza", "GEOMETRY = AXYZ\n")).geometry.isPlain());
    EXPECT_EQ(sink_.all().size(), 0U);
    EXPECT_EQ(facts("mill_xyza", "GEOMETRY = AX9\nMACHINE_TYPE_HINT = PRESS\n").look.geometry, "XYZABCUVW");
    EXPECT_EQ(sink_.all().size(), 2U) << "unknown keys are reported";
}

/// All pieces until the end.
std::string all_of(PieceQueue &pieces) {
    std::string bytes, piece;
    while (true) {
        switch (pieces.take(piece, [] {})) {
        case PieceQueue::State::PIECE: bytes += piece; break;
        case PieceQueue::State::LATER: std::this_thread::yield(); break;
        case PieceQueue::State::END: return bytes;
        }
    }
}

TEST_F(UiMachine, AProgramIsReadAsItsPath) {
    const auto loaded = load("mill_mm");
    ASSERT_NE(loaded, nullptr);
    const std::string path = (folder_ / "p.ngc").string();
    std::ofstream(path) << "G21 G90 F1000\nG1 X10\nG2 X20 I5\nG1 Q\nM2\n";
    PathReaders readers(*loaded, {});
    const auto pieces = readers.read(path);
    ASSERT_TRUE(pieces.has_value());
    const std::string bytes = all_of(**pieces);
    EXPECT_NE(bytes.find("p.ngc:4"), std::string::npos) << "the error with its place";
    std::uint32_t kind = 0, size = 0, count = 0;
    std::memcpy(&kind, bytes.data(), 4);
    std::memcpy(&size, bytes.data() + 4, 4);
    std::memcpy(&count, bytes.data() + 8, 4);
    EXPECT_EQ(kind, 5U) << "feed and tool of what comes";
    EXPECT_EQ(count, 1U);
    std::memcpy(&kind, bytes.data() + 8 + size, 4);
    std::memcpy(&count, bytes.data() + 16 + size, 4);
    EXPECT_EQ(kind, 1U);
    EXPECT_GT(count, 10U);
    EXPECT_EQ(bytes.size() % 4, 0U);
}

/// Content of the stream of times: seconds of each line, the last point, the text at its end.
struct Times {
    std::map<std::uint32_t, double> by_line;
    std::map<std::uint32_t, float> speeds;
    std::uint32_t point = 0;
    std::string sum, error;

    explicit Times(const std::string &bytes) {
        for (std::size_t at = 0; at < bytes.size();) {
            const auto word = [&](std::size_t place) {
                std::uint32_t value = 0;
                std::memcpy(&value, bytes.data() + place, 4);
                return value;
            };
            const std::uint32_t kind = word(at), size = word(at + 4);
            at += 8;
            for (std::size_t i = 0; kind == 7 && i < word(at); ++i) {
                const std::size_t move = at + 4 + 16 * i;
                float seconds = 0, speed = 0;
                std::memcpy(&seconds, bytes.data() + move + 8, 4);
                std::memcpy(&speed, bytes.data() + move + 12, 4);
                EXPECT_GE(word(move), point) << "points rise";
                point = word(move);
                by_line[word(move + 4)] += seconds;
                float &top = speeds[word(move + 4)];
                top = std::max(top, speed);
            }
            (kind == 8 ? sum : kind == 4 ? error : unused_) = kind == 7 ? "" : bytes.substr(at, size);
            at += size;
        }
    }

  private:
    std::string unused_;
};

TEST_F(UiMachine, TheTimeOfEachMoveIsThePlanners) {
    const auto loaded = load("mill_mm");
    ASSERT_NE(loaded, nullptr);
    const std::string path = (folder_ / "p.ngc").string();
    std::ofstream(path) << "G21 G90 G61 F600\nG1 X100\nG4 P2.5\nG2 X101 I0.5 F60000\nG0 X0\nM2\n";
    PathReaders readers(*loaded, {});
    const Times plain(all_of(**readers.read_times(path, {})));
    EXPECT_NEAR(plain.by_line.at(2), 10, 0.1) << "100 mm at 10 mm/s";
    EXPECT_NEAR(plain.speeds.at(2), 10, 0.01);
    EXPECT_NEAR(plain.by_line.at(3), 2.5, 1e-6);
    EXPECT_LT(plain.speeds.at(4), 100) << "so small a circle allows less than its feed";
    EXPECT_EQ(plain.error, "");
    EXPECT_NE(plain.sum.find(R"("line":4)"), std::string::npos) << plain.sum;
    EXPECT_NE(plain.sum.find("curvature: acceleration of"), std::string::npos) << plain.sum;
    const auto pieces = readers.read(path);
    const std::string bytes = all_of(**pieces);
    std::uint32_t points = 0;
    std::memcpy(&points, bytes.data() + bytes.size() - 4, 4);
    EXPECT_EQ(plain.point + 1, points) << "points are counted as those of the path";
    const Times half(all_of(**readers.read_times(path, {.feed = 0.5})));
    EXPECT_NEAR(half.by_line.at(2), 20, 0.1);
    EXPECT_NEAR(half.by_line.at(5), plain.by_line.at(5), 0.01) << "a rapid move has no feed";
    const Times slow(all_of(**readers.read_times(path, {.rapid = 0.1, .max_velocity = 5})));
    EXPECT_NEAR(slow.by_line.at(2), 20, 0.1) << "the maximum speed limits all moves";
    EXPECT_GT(slow.by_line.at(5), 2 * plain.by_line.at(5));
}

TEST_F(UiMachine, AProgramWithErrorsHasNoTime) {
    const auto loaded = load("mill_mm");
    ASSERT_NE(loaded, nullptr);
    const std::string path = (folder_ / "p.ngc").string();
    std::ofstream(path) << "G21 G90 F600\nG1 X100\nG1 Q\nM2\n";
    PathReaders readers(*loaded, {});
    const Times times(all_of(**readers.read_times(path, {})));
    EXPECT_EQ(times.sum, "");
    EXPECT_NE(times.error.find("p.ngc:3"), std::string::npos);
}

/// Output of a filter with this shell script, and the program that it has created.
class Filter : public UiMachine {
  protected:
    std::string run(const std::string &script, const std::function<void(PieceQueue &)> &meanwhile = {}) {
        const std::string path = (folder_ / "filter").string();
        std::ofstream(path) << "#!/bin/sh\n" << script;
        fs::permissions(path, fs::perms::owner_all);
        std::ofstream(folder_ / "it's a picture.png") << "pixels";
        PieceQueue pieces;
        const FilterRun filter{"./filter -x", folder_.string(), (folder_ / "it's a picture.png").string(),
                               made_};
        std::thread other([&] {
            run_filter(filter, pieces);
            pieces.end();
        });
        if (meanwhile) {
            meanwhile(pieces);
        }
        const std::string told = all_of(pieces);
        other.join();
        return told;
    }
    std::string made() const { return read_file(made_).value_or("none"); }
    std::size_t files_beside() const {
        const fs::path folder = fs::path(made_).parent_path();
        return fs::exists(folder)
                   ? static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), {}))
                   : 0;
    }
    std::string made_ = (folder_ / "made/by/picture.png.ngc").string();
};

TEST_F(Filter, MakesAProgramAndTellsItsProgress) {
    const std::string told =
        run("echo FILTER_PROGRESS=10 >&2; echo FILTER_PROGRESS=10 >&2; echo fine >&2\n"
            "echo FILTER_PROGRESS=100 >&2; echo \"($1 $2 $AXIS_PROGRESS_BAR)\"; echo M2\n");
    EXPECT_EQ(told, "{\"progress\":10}\n{\"progress\":100}\n{\"made\":\"" + made_ + "\"}\n");
    EXPECT_EQ(made(), "(-x " + (folder_ / "it's a picture.png").string() + " 1)\nM2\n");
}

TEST_F(Filter, WhatGoesWrongIsToldAndLeavesTheProgramOfBefore) {
    run("echo M2\n");
    for (const auto &[script, why] :
         {std::pair{"echo half; echo no depth in it >&2; exit 3\n",
                    "has ended with status 3: no depth in it"},
          std::pair{"kill -9 $$\n", "has ended with status 137"},
          std::pair{"echo nothing to cut >&2\n", "produced no program: nothing to cut"}}) {
        const std::string told = run(script);
        EXPECT_NE(told.find("\"error\":\"the filter './filter -x' "), std::string::npos) << told;
        EXPECT_NE(told.find(why), std::string::npos) << told;
        EXPECT_EQ(made(), "M2\n");
        EXPECT_EQ(files_beside(), 1U);
    }
}

TEST_F(Filter, EndsWithAllThatItHasStartedWhenNobodyWaits) {
    const std::string mark = (folder_ / "pid").string();
    run("sh -c 'echo $$ > pid; trap \"\" TERM; while :; do sleep 0.1; done' &\nwait\n",
        [&](PieceQueue &pieces) {
            while (read_file(mark).value_or("").empty()) {
                std::this_thread::yield();
            }
            pieces.cancel();
        });
    const int pid = std::stoi(read_file(mark).value_or("0"));
    ASSERT_GT(pid, 0);
    while (::kill(pid, 0) == 0) {
        std::this_thread::yield();  // until the filter has ended, or the test times out
    }
    EXPECT_EQ(made(), "none");
    EXPECT_EQ(files_beside(), 0U);
}

TEST_F(UiMachine, FiltersAreThoseOfTheIniFile) {
    const auto loaded =
        load("mill_mm", "",
             "\n[FILTER]\nPROGRAM_EXTENSION = .png,.gif Images\npng = image-to-gcode --x\nPY = python3\n");
    const auto filters = filters_of(loaded->ini);
    EXPECT_EQ(filters,
              (std::map<std::string, std::string>{{".png", "image-to-gcode --x"}, {".py", "python3"}}));
    EXPECT_EQ(machine_facts(*loaded, sink_).filters.extensions, (std::vector<std::string>{".png", ".py"}));
}

TEST_F(UiMachine, APipeIsNotRead) {
    const auto loaded = load("mill_mm");
    ASSERT_NE(loaded, nullptr);
    const std::string path = (folder_ / "pipe.ngc").string();
    ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
    PathReaders readers(*loaded, {});
    const auto pieces = readers.read(path);
    ASSERT_TRUE(pieces.has_value());
    EXPECT_NE(all_of(**pieces).find("pipe.ngc is not a file"), std::string::npos);
}

TEST_F(UiMachine, ReadersEndWhenNobodyReads) {
    const auto loaded = load("mill_mm");
    const std::string path = (folder_ / "long.ngc").string();
    std::ofstream(path) << "G21 F1000\no1 repeat [10000000]\nG1 X1\nG1 X0\no1 endrepeat\nM2\n";
    PathReaders readers(*loaded, {});
    const auto read = [&](const std::string &address, Role role) {
        return readers.read(path, {address, role}).has_value();
    };
    for (const std::string viewer : {"10.0.0.1", "10.0.0.2"}) {
        for (std::size_t i = 0; i < PathReaders::MOST_OF_VIEWER; ++i) {
            EXPECT_TRUE(read(viewer, Role::VIEW));
        }
        EXPECT_FALSE(read(viewer, Role::VIEW)) << "one client takes no more";
    }
    EXPECT_FALSE(read("10.0.0.3", Role::VIEW)) << "viewers leave places for operators";
    for (std::size_t i = 0; i < PathReaders::MOST_OF_CLIENT; ++i) {
        EXPECT_TRUE(read("10.0.0.1", Role::OPERATE));
    }
    EXPECT_FALSE(read("10.0.0.4", Role::OPERATE)) << "as many as can be in all";
}  // the destructor ends them

TEST_F(UiMachine, ALongMoveEndsWhenNobodyReadsOrALimitIsExceeded) {
    const auto loaded = load("mill_mm");
    const std::string path = (folder_ / "slow.ngc").string();
    std::ofstream(path) << "G21 G91 F0.001\no1 repeat [100000]\nG1 X0.001 Y0.0005\nG1 X-0.001 Y-0.0005\no1 "
                           "endrepeat\nG90 G1 X1000000000000000\nM2\n";
    {
        PathReaders readers(*loaded, {}, {.cpu_s = 0.02});
        const auto pieces = readers.read_times(path, {.feed = 0.001});
        ASSERT_TRUE(pieces.has_value());
        const Times times(all_of(**pieces));
        EXPECT_EQ(times.sum, "");
        EXPECT_NE(times.error.find("slow.ngc: reading takes longer"), std::string::npos) << times.error;
    }
    PathReaders readers(*loaded, {});
    ASSERT_TRUE(readers.read_times(path, {.feed = 0.001}).has_value());
}  // the destructor ends it

}  // namespace
}  // namespace mw::screen
