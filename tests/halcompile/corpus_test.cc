// SPDX-License-Identifier: GPL-2.0-or-later
// Components written as users write them, compiled by the program halcompile, loaded, and seen to work.
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>

#include "hal/api/hal.h"
#include "hal/api/kinematics.h"
#include "hal/core/host.hh"
#include "rtapi/virtual_scheduler.hh"

extern char **environ;

namespace mw::hal {
namespace {

namespace fs = std::filesystem;

/// A folder for what is compiled, unlike that of any other test.
struct Folder {
    fs::path path = fs::path(::testing::TempDir()) / ("mw_corpus_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

/// Runs a program to its end; its exit status and what it wrote.
struct Outcome {
    int status = -1;
    std::string text;
};
Outcome run(const std::string &command) {
    Outcome outcome;
    std::FILE *pipe = ::popen((command + " 2>&1").c_str(), "r");
    char block[512];
    for (std::size_t got = 0; pipe != nullptr && (got = std::fread(block, 1, sizeof block, pipe)) > 0;) {
        outcome.text.append(block, got);
    }
    const int status = pipe == nullptr ? -1 : ::pclose(pipe);
    outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return outcome;
}

Outcome halcompile(const std::string &words) {
    return run(std::string(MW_BIN_DIR) + "/halcompile " + words);
}

std::string corpus(const std::string &file) {
    return std::string(MW_CORPUS) + "/" + file;
}

struct Corpus : ::testing::Test {
    Folder folder;
    std::vector<std::string> messages;
    rtapi::Log log{rtapi::Log::Mode::SYNCHRONOUS,
                   [](void *self, rtapi::LogLevel, const char *text) {
                       static_cast<std::vector<std::string> *>(self)->emplace_back(text);
                   },
                   &messages};
    rtapi::VirtualScheduler clock;
    std::unique_ptr<LocalHost> host;

    Corpus() {
        HalOptions options;
        options.name = "corpus" + std::to_string(::getpid());
        options.isShared = true;
        options.scheduler = &clock;
        options.log = &log;
        auto made = LocalHost::create(options, {folder.path});
        EXPECT_TRUE(made) << made.error().str();
        host = std::move(*made);
        EXPECT_TRUE(hal().new_thread("t", 1'000'000));
    }
    Hal &hal() { return host->hal(); }

    /// Compiles a file of the corpus; its messages.
    std::string compile(const std::string &file, const std::string &words = "") {
        const std::string name = fs::path(file).stem();
        const bool isProgram = file.starts_with("usr") || file == "cusr.c" || file.ends_with(".py");
        const Outcome done =
            halcompile("--compile --extra-compile-args='-O1 -g0' -o " + (folder.path / name).string() +
                       (isProgram ? " " : ".so ") + words + " " + corpus(file));
        EXPECT_EQ(done.status, 0) << done.text;
        return done.text;
    }
    /// Compiles and loads; "ok" or the error.
    std::string load(const std::string &file, const std::vector<std::string> &args = {}) {
        compile(file);
        return load_only(fs::path(file).stem(), args);
    }
    std::string load_only(const std::string &name, const std::vector<std::string> &args = {}) {
        const auto done = host->load_realtime(name, args);
        return done ? "ok" : done.error().str();
    }
    /// Puts functions into the thread and runs it for some periods.
    void cycle(const std::vector<std::string> &functions, int periods = 1) {
        for (const std::string &function : functions) {
            const auto done = hal().add_function(function, "t");
            EXPECT_TRUE(done) << done.error().str();
        }
        EXPECT_TRUE(hal().start_threads());
        more(periods);
    }
    void more(int periods) { clock.run_until(clock.now_ns() + periods * 1'000'000LL); }
    double number(const std::string &name) {
        const auto value = hal().get(name);
        EXPECT_TRUE(value) << name;
        return value ? value->as_number() : -999;
    }
    void set(const std::string &name, const std::string &value) {
        const auto done = hal().set(name, std::string_view(value));
        EXPECT_TRUE(done) << done.error().str();
    }
    std::string pins(const std::string &glob) {
        std::string names;
        for (const PinInfo &pin : hal().pins(glob)) {
            names += pin.name + " ";
        }
        return names;
    }
};

TEST_F(Corpus, OneFunctionWithoutTheWord_B2) {
    ASSERT_EQ(load("gain.comp"), "ok");
    set("gain.0.in", "4");
    cycle({"gain.0"});
    EXPECT_EQ(number("gain.0.out"), 10);
    EXPECT_EQ(pins("gain*"), "gain.0.in gain.0.out gain.0.time ");
    EXPECT_EQ(number("gain.0.tmax"), 0);
}

TEST_F(Corpus, StartValuesNamesAndBits_B2) {
    ASSERT_EQ(load("onoff.comp", {"names=bed,nozzle"}), "ok");
    EXPECT_EQ(number("bed.setpoint"), 20);
    EXPECT_EQ(number("nozzle.enable"), 1);
    set("bed.value", "18");
    cycle({"bed", "nozzle"});
    EXPECT_EQ(number("bed.heat"), 1);
    set("bed.value", "20.5");
    more(1);
    EXPECT_EQ(number("bed.heat"), 1) << "in the band";
    set("bed.value", "22");
    more(1);
    EXPECT_EQ(number("bed.heat"), 0);
}

TEST_F(Corpus, ArraysOfFixedAndDependentSize_B2) {
    ASSERT_EQ(load("shiftreg.comp"), "ok");
    ASSERT_EQ(load("gate.comp", {"count=3", "personality=0x3,0x212,0x711"}), "ok");
    EXPECT_EQ(pins("gate.0.*"), "gate.0.in-00 gate.0.in-01 gate.0.in-02 gate.0.sum gate.0.time ");
    EXPECT_EQ(pins("gate.1.*"), "gate.1.average gate.1.in-00 gate.1.in-01 gate.1.sum gate.1.time ");
    EXPECT_NE(load_only("gate"), "ok") << "twice";
    set("gate.1.in-00", "3");
    set("gate.1.in-01", "4");
    set("shiftreg.0.in", "1");
    cycle({"gate.1", "shiftreg.0"}, 3);
    EXPECT_EQ(number("gate.1.average"), 3.5);
    EXPECT_EQ(number("shiftreg.0.out-02"), 1);
    EXPECT_EQ(number("shiftreg.0.out-03"), 0);
}

TEST_F(Corpus, APersonalityThatAsksTooMuchIsRefused_B2) {
    EXPECT_NE(load("gate.comp", {"personality=0x520"})
                  .find("personality asks for 5 of weight-#, 0 to 4 are possible"),
              std::string::npos);
    EXPECT_EQ(load_only("gate", {"personality=0x420"}), "ok");
    EXPECT_EQ(number("gate.0.weight-3"), 1.5);
}

TEST_F(Corpus, PersonalitiesWrapAtTheirLimit_B2) {
    compile("gate.comp", "--personalities=2");
    ASSERT_EQ(load_only("gate", {"count=3", "personality=1,2"}), "ok");
    EXPECT_EQ(pins("gate.2.in*"), "gate.2.in-00 ") << "takes the first again";
    EXPECT_FALSE(messages.empty());
}

TEST_F(Corpus, NamesWithNumbersInside_B2) {
    ASSERT_EQ(load("bank.comp"), "ok");
    set("bank.0.ch.1.in", "2");
    cycle({"bank.0"});
    EXPECT_EQ(number("bank.0.ch.1.out"), 2.5);
    EXPECT_EQ(number("bank.0.runs"), 17);
}

TEST_F(Corpus, TimeAndVariables_B2) {
    ASSERT_EQ(load("pulse.comp"), "ok");
    cycle({"pulse.0"}, 2);
    set("pulse.0.trigger", "1");
    more(2);
    EXPECT_EQ(number("pulse.0.out"), 1);
    more(3);
    EXPECT_EQ(number("pulse.0.out"), 0);
}

TEST_F(Corpus, SeveralFunctionsWithNamesOfTheCLibrary_B2) {
    ASSERT_EQ(load("twofun.comp", {"count=2"}), "ok");
    set("twofun.1.raw", "8");
    cycle({"twofun.1.read", "twofun.1.write"});
    EXPECT_EQ(number("twofun.1.cooked"), 16);
}

TEST_F(Corpus, OptionsForInstances_B2) {
    ASSERT_EQ(load("single.comp"), "ok");
    cycle({"single.tick"}, 5);
    EXPECT_EQ(number("single.ticks"), 5);
    ASSERT_EQ(load("many.comp"), "ok");
    EXPECT_EQ(pins("many.*.alive"), "many.0.alive many.1.alive many.2.alive ");
    const UseInstance use(&hal());
    EXPECT_EQ(hal_comp_invoke_make("many", "other", ""), 0);
    EXPECT_EQ(number("other.alive"), 1);
    EXPECT_NE(load("onoff.comp", {"count=1", "names=a"}).find("give count= or names=, not both"),
              std::string::npos);
    EXPECT_EQ(load_only("onoff", {"count=300"}), "ok");
}

TEST_F(Corpus, CountFunctionSetUpAndCleanUp_B2) {
    ASSERT_EQ(load("counted.comp", {"at=5,6"}), "ok");
    cycle({"counted.0", "counted.1"});
    EXPECT_EQ(number("counted.1.address"), 6);
    EXPECT_TRUE(host->unload_realtime("counted"));
    ASSERT_FALSE(messages.empty());
    EXPECT_EQ(messages.back(), "counted: cleaned up");
    const std::string refused = load_only("counted", {"at=5,-1"});
    EXPECT_NE(refused.find("Numerical result out of range"), std::string::npos) << refused;
    EXPECT_EQ(pins("counted*"), "");
}

TEST_F(Corpus, SetUpBeforeAndAfterThePins_B2) {
    ASSERT_EQ(load("setup.comp", {"names=abcde,xy"}), "ok");
    EXPECT_EQ(number("xy.number"), 11);
    cycle({"abcde"});
    EXPECT_EQ(number("abcde.length"), 5);
}

TEST_F(Corpus, ModuleParameters_B2) {
    ASSERT_EQ(load("modp.comp", {"far=1000", "list=1,2", "title=hello", "table=a,bc"}), "ok");
    cycle({"modp.0"});
    EXPECT_EQ(number("modp.0.sum"), 3 + 1000 + 1 + 2 + 7 + 7);
    EXPECT_EQ(number("modp.0.letters"), 305);
}

TEST_F(Corpus, TypesOfItsOwnPointersAndData_B2) {
    ASSERT_EQ(load("structs.comp"), "ok");
    ASSERT_EQ(load("ptrs.comp", {"count=2"}), "ok");
    ASSERT_EQ(load("olddata.comp"), "ok");
    set("structs.0.in", "1");
    cycle({"structs.0", "ptrs.1", "olddata.0"}, 2);
    EXPECT_EQ(number("structs.0.out"), 6);
    EXPECT_EQ(number("structs.0.check"), 1 + 40 + 100 - 5000 + 'c');
    EXPECT_EQ(number("ptrs.1.sum"), 12);
    EXPECT_EQ(number("olddata.0.out"), 2.5);
    EXPECT_TRUE(host->unload_realtime("ptrs"));
}

TEST_F(Corpus, HeadersAndWideTypes_B2) {
    ASSERT_EQ(load("incl.comp"), "ok");
    ASSERT_EQ(load("wide.comp"), "ok");
    ASSERT_EQ(load("hal_tick.comp"), "ok");
    set("incl.0.angle", "0");
    cycle({"incl.0", "wide.0", "tick.0.run-now"});
    EXPECT_EQ(number("incl.0.cos"), 1);
    EXPECT_EQ(number("wide.0.sum"), 999999999);
    EXPECT_EQ(hal().get("wide.0.top")->as_u64(), ~std::uint64_t{0});
    EXPECT_EQ(number("tick.0.tick"), 1);
    EXPECT_TRUE(hal().component("hal_tick"));
}

TEST_F(Corpus, KinematicsHomingAndPlannerModules_B2) {
    ASSERT_EQ(load("polar.comp"), "ok");
    ASSERT_EQ(load("homeall.comp"), "ok");
    ASSERT_EQ(load("tpline.comp"), "ok");
    EXPECT_EQ(number("homeall.is-module"), 1);
    const auto inverse =
        reinterpret_cast<decltype(&kinematicsInverse)>(host->loader().find_symbol("kinematicsInverse"));
    ASSERT_NE(inverse, nullptr);
    EmcPose pose{};
    pose.tran.y = 2;
    double joints[3] = {};
    EXPECT_EQ(inverse(&pose, joints, nullptr, nullptr), 0);
    EXPECT_DOUBLE_EQ(joints[0], 2);
    EXPECT_DOUBLE_EQ(joints[1], 90);
    for (const char *symbol :
         {"kinematicsType", "kinematicsSwitchable", "do_homing", "get_allhomed", "tpline_length"}) {
        EXPECT_NE(host->loader().find_symbol(symbol), nullptr) << symbol;
    }
    ASSERT_TRUE(host->unload_realtime("polar"));
    ASSERT_EQ(load("kinsc.c"), "ok");
    EXPECT_NE(host->loader().find_symbol("kinematicsForward"), nullptr);
}

TEST_F(Corpus, AComponentThatMakesItsInstancesItself_B2) {
    ASSERT_EQ(load("ownapp.comp", {"how_many=3"}), "ok");
    cycle({"mine.c"});
    EXPECT_EQ(number("mine.c.number"), 10);
}

TEST_F(Corpus, PortsByValueAndByAddress_B2) {
    ASSERT_EQ(load("portecho.comp"), "ok");
    for (const char *name : {"to", "from"}) {
        ASSERT_TRUE(hal().new_signal(name, Type::PORT));
        ASSERT_TRUE(hal().set_signal(name, std::string_view("32")));
    }
    const int comp = *hal().new_component("user");
    const auto in = hal().new_pin("user.in", Type::PORT, Dir::IN, comp);
    const auto out = hal().new_pin("user.out", Type::PORT, Dir::OUT, comp);
    ASSERT_TRUE(hal().link("user.out", "to"));
    ASSERT_TRUE(hal().link("portecho.0.in", "to"));
    ASSERT_TRUE(hal().link("portecho.0.out", "from"));
    ASSERT_TRUE(hal().link("user.in", "from"));
    const UseInstance use(&hal());
    ASSERT_TRUE(hal_port_write(static_cast<hal_port_t *>(**out), "abc", 3));
    cycle({"portecho.0"});
    EXPECT_EQ(number("portecho.0.waiting"), 3);
    char text[4] = {};
    EXPECT_TRUE(hal_port_read(static_cast<hal_port_t *>(**in), text, 3));
    EXPECT_STREQ(text, "ABC");
}

TEST_F(Corpus, ModulesShareWhatTheyExportAndNothingElse_B5) {
    ASSERT_EQ(load("giver.comp"), "ok");
    ASSERT_EQ(load("taker.comp"), "ok");
    cycle({"taker.0", "giver"});
    EXPECT_EQ(number("taker.0.answer"), 44) << "its own corpus_private";
    EXPECT_EQ(number("giver.asked"), 1);
    const std::string refused = load("snoop.comp");
    EXPECT_NE(refused.find("snoop: dlopen: "), std::string::npos) << refused;
    EXPECT_NE(refused.find("undefined symbol: corpus_hidden"), std::string::npos) << refused;
    EXPECT_FALSE(host->unload_realtime("giver")) << "taker uses it";
    EXPECT_TRUE(host->unload_realtime("taker"));
    EXPECT_TRUE(host->unload_realtime("giver"));
}

TEST_F(Corpus, ModulesInCAndCxx_B5) {
    ASSERT_EQ(load("cmod.c", {"ch=x,y", "scale=3"}), "ok");
    ASSERT_EQ(load("cxxmod.cc"), "ok");
    set("cxxmod.in", "8");
    cycle({"cmod.run", "cxxmod.run"}, 2);
    EXPECT_EQ(number("cmod.y.count"), 6);
    EXPECT_EQ(number("cmod.x.speed"), 3000);
    EXPECT_EQ(number("cmod.x.flag"), 1);
    EXPECT_EQ(number("cxxmod.out"), 6);
    EXPECT_TRUE(host->unload_realtime("cmod"));
    const std::string refused = load_only("cmod");
    EXPECT_NE(refused.find("cmod: no channels"), std::string::npos) << refused;
    EXPECT_NE(refused.find("Numerical result out of range"), std::string::npos) << refused;
}

/// A started program, ended with the test.
struct Program {
    pid_t pid = 0;
    explicit Program(std::vector<std::string> words) {
        std::vector<char *> argv;
        for (std::string &word : words) {
            argv.push_back(word.data());
        }
        argv.push_back(nullptr);
        EXPECT_EQ(::posix_spawn(&pid, argv[0], nullptr, nullptr, argv.data(), environ), 0);
    }
    ~Program() {
        if (pid > 0) {
            ::kill(pid, SIGTERM);
            ::waitpid(pid, nullptr, 0);
        }
    }
    Program(const Program &) = delete;
    Program &operator=(const Program &) = delete;
};

bool isSoon(const std::function<bool()> &condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) {
            return false;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
}

TEST_F(Corpus, Programs_B2) {
    compile("usrcount.comp");
    compile("usrinit.comp");
    compile("cusr.c", "--userspace");
    ::setenv("MILLWRIGHT_INSTANCE", hal().name().c_str(), 1);
    const fs::path ini = folder.path / "a.ini";
    std::ofstream(ini) << "[TEST]\nLEVEL = 17\n";
    const Program counting({folder.path / "usrcount", "names=a,b", "pace=2"});
    const Program initialised({folder.path / "usrinit", ini, "count=1"});
    const Program looking({folder.path / "cusr"});
    ::unsetenv("MILLWRIGHT_INSTANCE");
    const auto reaches = [&](const std::string &name, double least) {
        const auto value = hal().get(name);
        return value && value->as_number() >= least;
    };
    EXPECT_TRUE(isSoon([&] { return reaches("b.count", 3); }));
    EXPECT_TRUE(isSoon([&] { return reaches("usrinit.0.from-ini", 17); }));
    EXPECT_TRUE(isSoon([&] { return reaches("cusr.seen", 10); }));
    EXPECT_EQ(number("usrinit.0.answer"), 42);
    EXPECT_EQ(number("usrinit.0.words"), 2) << "count= is taken out";
    EXPECT_EQ(hal().component("usrcount")->type, CompType::USER);
}

TEST_F(Corpus, PythonPrograms_B2) {
    compile("pyusr.py", "--userspace");
    const fs::path program = folder.path / "pyusr";
    EXPECT_EQ(::access(program.c_str(), X_OK), 0);
    std::ofstream(folder.path / "bad.py") << "#!/usr/bin/env python3\ndef (:\n";
    EXPECT_NE(halcompile("--compile --userspace " + (folder.path / "bad.py").string()).status, 0);
}

TEST_F(Corpus, InstallsWhereItIsTold_B2) {
    const std::string to = folder.path.string();
    ::setenv("RTLIB_DIR", (to + "/rt").c_str(), 1);
    ::setenv("EMC2_HOME", (to + "/home").c_str(), 1);
    const Outcome done = halcompile("--install " + corpus("gain.comp") + " " + corpus("usrcount.comp"));
    ::unsetenv("RTLIB_DIR");
    ::unsetenv("EMC2_HOME");
    EXPECT_EQ(done.status, 0) << done.text;
    EXPECT_EQ(done.text, "");
    EXPECT_EQ(::access((to + "/rt/gain.so").c_str(), R_OK), 0);
    EXPECT_EQ(fs::status(to + "/rt/gain.so").permissions() & fs::perms::owner_exec, fs::perms::none);
    EXPECT_EQ(::access((to + "/home/bin/usrcount").c_str(), X_OK), 0);
    EXPECT_EQ(::access((to + "/home/man/man9/gain.9").c_str(), R_OK), 0);
    EXPECT_EQ(::access((to + "/home/man/man1/usrcount.1").c_str(), R_OK), 0);
}

TEST_F(Corpus, ThePageOfTheLanguage_B2) {
    std::ifstream page(std::string(MW_CORPUS) + "/../../../docs/hal/comp.md");
    std::string line;
    std::string text;
    bool isExample = false;
    int examples = 0;
    while (std::getline(page, line)) {
        if (!isExample && line == "```comp") {
            isExample = true;
            text.clear();
        } else if (isExample && line == "```") {
            isExample = false;
            ++examples;
            const std::string name = text.substr(10, text.find_first_of(" ;", 10) - 10);
            const fs::path file = folder.path / (name + ".comp");
            std::ofstream(file) << text;
            const Outcome done = halcompile("--compile --extra-compile-args='-O1 -g0' " + file.string());
            EXPECT_EQ(done.status, 0) << name << ": " << done.text;
            if (text.find("option userspace") == std::string::npos) {
                EXPECT_EQ(load_only(name), "ok");
            }
        } else if (isExample) {
            text += line + "\n";
        }
    }
    EXPECT_GE(examples, 5);
    cycle({"average.0", "batch.0.count"});
}

TEST_F(Corpus, TheMakefileLinksSeveralFiles_B2) {
    if (run("make --version").status != 0) {
        GTEST_SKIP() << "make is not installed";
    }
    std::ofstream(folder.path / "one.c")
        << "#include \"rtapi_app.h\"\n#include \"hal.h\"\nint two(void);\nstatic int id;\n"
           "int shown(void) { return two(); }\nEXPORT_SYMBOL(shown);\n"
           "int rtapi_app_main(void) { id = hal_init(\"pair\"); hal_ready(id); "
           "return id < 0 ? id : 0; }\nvoid rtapi_app_exit(void) { hal_exit(id); }\n";
    std::ofstream(folder.path / "two.c") << "int two(void);\nint two(void) { return 22; }\n";
    std::ofstream(folder.path / "Makefile") << "obj-m := pair.o\npair-objs := one.o two.o\n"
                                               "include $(shell $(HALCOMPILE) --print-modinc)\n";
    const Outcome done =
        run("make -C " + folder.path.string() + " HALCOMPILE=" + std::string(MW_BIN_DIR) + "/halcompile");
    ASSERT_EQ(done.status, 0) << done.text;
    ASSERT_EQ(load_only("pair"), "ok");
    EXPECT_NE(host->loader().find_symbol("shown"), nullptr);
    EXPECT_EQ(host->loader().find_symbol("two"), nullptr);
}

TEST_F(Corpus, ErrorsPointAtTheComponentFile_B2) {
    const fs::path file = folder.path / "wrong.comp";
    std::ofstream(file) << "component wrong;\npin in float in;\nfunction _;\nlicense \"GPL\";\n;;\nin = 5;\n";
    const Outcome done = halcompile("--compile " + file.string());
    EXPECT_EQ(done.status, 1);
    EXPECT_NE(done.text.find("wrong.comp:6:4: error: assignment of read-only location"), std::string::npos)
        << done.text;
    EXPECT_FALSE(fs::exists(folder.path / "wrong.so"));
    fs::rename(file, folder.path / "other.comp");
    EXPECT_EQ(halcompile((folder.path / "other.comp").string()).status, 1);
    EXPECT_FALSE(fs::exists(folder.path / "other.c"));
    EXPECT_FALSE(fs::exists(folder.path / "wrong.c"));
}

}  // namespace
}  // namespace mw::hal
