// SPDX-License-Identifier: GPL-2.0-or-later
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hal/script/two_pass.hh"
#include "runtime/virtual_scheduler.hh"

namespace mw::hal::script {
namespace {

namespace fs = std::filesystem;

class TextOutput final : public Output {
  public:
    void data(std::string_view text) override { answers += text; }
    void info(std::string_view text) override { infos += std::string(text) + "\n"; }
    void note(std::string_view) override {}
    void warning(const Error &) override {}
    void error(const Error &error) override { errors += error.message + "\n"; }

    std::string answers, infos, errors;
};

/// Records the modules to be loaded.
class RecordingHost final : public Host {
  public:
    explicit RecordingHost(const InstanceOptions &options) : hal_(std::move(*Instance::create(options))) {}
    Instance &hal() noexcept override { return *hal_; }
    Result<> load_realtime(const std::string &name, const std::vector<std::string> &args) override {
        std::string line = name;
        for (const std::string &arg : args) {
            line += " " + arg;
        }
        lines.push_back(line);
        return name == "broken" ? fail("it is broken") : Result<>{};
    }
    Result<> unload_realtime(const std::string &) override { return {}; }
    Result<bool> isModuleLoaded(const std::string &) override { return false; }
    Result<std::vector<std::string>> modules() override { return std::vector<std::string>{}; }
    Result<> set_log_level(runtime::LogLevel) override { return {}; }

    std::vector<std::string> lines;

  private:
    std::unique_ptr<Instance> hal_;
};

class TwoPassTest : public ::testing::Test {
  protected:
    TwoPassTest() { fs::create_directories(folder); }
    ~TwoPassTest() override { fs::remove_all(folder); }

    /// Runs files a.hal, b.hal... with these texts; returns the output, errors last.
    std::string run(const std::vector<std::string> &texts, const std::string &keywords = "on",
                    TwoPassReport report = TwoPassReport::NOTHING) {
        InstanceOptions hal_options;
        hal_options.name = "two-pass-test";
        hal_options.scheduler = &clock;
        host = std::make_unique<RecordingHost>(hal_options);
        std::vector<HalFileEntry> files;
        for (const std::string &text : texts) {
            const std::string name = std::string(1, static_cast<char>('a' + files.size())) + ".hal";
            std::ofstream(folder / name) << text;
            files.push_back({name, {"test.ini", static_cast<int>(files.size()) + 1, 1}});
        }
        SessionOptions options;
        options.folders = {folder};
        TextOutput output;
        Session session(*host, programs, output, options);
        last_result = run_two_pass(session, files, keywords, report);
        infos = output.infos;
        return output.answers + output.errors;
    }

    fs::path folder = fs::temp_directory_path() / ("mw_twopass_" + std::to_string(::getpid()));
    runtime::VirtualScheduler clock;
    std::unique_ptr<RecordingHost> host;
    InProcessProgramHost programs;
    Result<> last_result;
    std::string infos;
};

TEST_F(TwoPassTest, LinesOfOneModuleBecomeOne) {
    EXPECT_EQ(run({"loadrt and2 names=a,b\nloadrt pid num_chan=2\nloadrt abs\n",
                   "loadrt and2 names=c\nloadrt or2 count=2\nloadrt pid num_chan=1 debug=1\nloadrt abs\n"
                   "loadrt or2 count=3\n"}),
              "");
    EXPECT_TRUE(last_result);
    EXPECT_EQ(host->lines,
              (std::vector<std::string>{"and2 names=a,b,c", "pid num_chan=3 debug=1", "abs", "or2 count=5"}));
}

TEST_F(TwoPassTest, PersonalitiesStayWithTheirInstances) {
    run({"loadrt logic names=a\nloadrt logic names=b,c personality=0x102,0x103\n",
         "loadrt logic names=d\nloadrt sum count=1 personality=1\nloadrt sum count=2 personality=2\n"});
    EXPECT_EQ(host->lines, (std::vector<std::string>{"logic names=a,b,c,d personality=0,0x102,0x103,0",
                                                     "sum count=3 personality=1,2,0"}));
}

TEST_F(TwoPassTest, WhatCannotBeMergedIsAnErrorWithBothPlaces) {
    EXPECT_EQ(run({"loadrt and2 names=a\n", "loadrt and2 count=2\n"}),
              "module 'and2' is loaded with names= elsewhere: it cannot have count= too\n");
    EXPECT_NE(run({"loadrt and2 names=a,b\n", "\nloadrt and2 names=c,b\n"})
                  .find("has the name 'b' twice, first at " + (folder / "a.hal").string() + ":1:13"),
              std::string::npos);
    EXPECT_NE(run({"loadrt step type=1\nloadrt step type=2\n"}).find("has type=2 here and type=1 at "),
              std::string::npos);
    EXPECT_EQ(run({"loadrt step count=x\n"}), "'x' is not a number of instances\n");
    EXPECT_TRUE(host->lines.empty());
    EXPECT_EQ(run({"loadrt broken names=a\n", "loadrt broken names=b\n"}),
              "it is broken (all lines together: loadrt broken names=a,b)\n");
}

TEST_F(TwoPassTest, EverythingElseRunsInTheSecondPassOnce) {
    EXPECT_EQ(run({"newsig one bit\nlist sig\nstype one\n", "sets one 1\ngets one\nlist sig\n"}),
              "\n\none \nbit\nTRUE\none \n")
        << "the answers of list are printed in the first pass too, as files written for LinuxCNC expect";
    EXPECT_TRUE(last_result);
    EXPECT_NE(run({"newsig one bit\nbogus\n"}).find("unknown command 'bogus'"), std::string::npos);
    EXPECT_FALSE(host->hal().signals().has("one")) << "found before anything was done";
}

TEST_F(TwoPassTest, ExcludedFilesRunAsAWholeAtTheirPlace) {
    const std::string text =
        run({"loadrt first\n", "#  NoTwoPass please\nloadrt inner\nbogus\nnewsig x bit\n", "loadrt last\n"},
            "on", TwoPassReport::FILES);
    EXPECT_EQ(host->lines, (std::vector<std::string>{"first", "inner", "last"}));
    EXPECT_TRUE(last_result) << "its failures stop nothing";
    EXPECT_TRUE(host->hal().signals().has("x"));
    const std::string at = folder.string();
    EXPECT_EQ(text, "twopass:invoked with <> options\ntwopass:found " + at + "/a.hal\ntwopass:found " + at +
                        "/b.hal\ntwopass:Sourcing " + at +
                        "/b.hal WITHOUT twopass processing\ntwopass:found " + at +
                        "/c.hal\nunknown command 'bogus'\n");
    EXPECT_NE(infos.find("Realtime module 'inner' loaded"), std::string::npos);
}

TEST_F(TwoPassTest, VerboseTellsTheSteps) {
    const std::string text = run({"loadrt and2 names=a\n"}, "on, verbose nodelete", TwoPassReport::FILES);
    EXPECT_NE(text.find("twopass:invoked with <verbose nodelete> options\ntwopass:found "),
              std::string::npos);
    EXPECT_NE(text.find("twopass: pass0:BEGIN\n"), std::string::npos);
    EXPECT_NE(text.find("twopass: loadrt and2 names=a\ntwopass: pass0:END\n"), std::string::npos);
    EXPECT_NE(text.find("twopass: pass1:END\n"), std::string::npos);
}

}  // namespace
}  // namespace mw::hal::script
