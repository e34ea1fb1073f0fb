// SPDX-License-Identifier: GPL-2.0-or-later
// Tests programs built by halcompile, and its other functions: installation, makefiles, messages.
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "tests/halcompile/corpus.hh"

extern char **environ;

namespace mw::hal {
namespace {

using Halcompile = Corpus;

/// A started program, which is stopped at the end of the test.
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

TEST_F(Halcompile, Programs) {
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
        const auto value = hal().values().get(name);
        return value && value->as_number() >= least;
    };
    EXPECT_TRUE(isSoon([&] { return reaches("b.count", 3); }));
    EXPECT_TRUE(isSoon([&] { return reaches("usrinit.0.from-ini", 17); }));
    EXPECT_TRUE(isSoon([&] { return reaches("cusr.seen", 10); }));
    EXPECT_EQ(number("usrinit.0.answer"), 42);
    EXPECT_EQ(number("usrinit.0.words"), 2) << "count= is taken out";
    EXPECT_EQ(hal().components().find("usrcount")->type, CompType::USER);
}

TEST_F(Halcompile, AProgramTakesCountOrNamesButNotBoth) {
    compile("usrcount.comp");
    ::setenv("MILLWRIGHT_INSTANCE", hal().name().c_str(), 1);
    Program refused({folder.path / "usrcount", "count=2", "names=a,b"});
    ::unsetenv("MILLWRIGHT_INSTANCE");
    int status = 0;
    ASSERT_EQ(::waitpid(refused.pid, &status, 0), refused.pid);
    refused.pid = 0;
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    EXPECT_FALSE(hal().components().find("usrcount"));
}

TEST_F(Halcompile, PythonPrograms) {
    compile("pyusr.py", "--userspace");
    const fs::path program = folder.path / "pyusr";
    EXPECT_EQ(::access(program.c_str(), X_OK), 0);
    if (!std::string_view(MW_PYTHON_FOLDER).empty()) {
        ::setenv("MILLWRIGHT_INSTANCE", hal().name().c_str(), 1);
        ::setenv("PYTHONPATH", MW_PYTHON_FOLDER, 1);
        const Program doubling({program});
        ::unsetenv("MILLWRIGHT_INSTANCE");
        EXPECT_TRUE(isSoon(
            [&] { return hal().components().find("pyusr") && hal().components().find("pyusr")->isReady; }));
        set("pyusr.in", "4");
        EXPECT_TRUE(isSoon([&] { return number("pyusr.out") == 8; }));
    }
    std::ofstream(folder.path / "bad.py") << "#!/usr/bin/env python3\ndef (:\n";
    EXPECT_NE(halcompile("--compile --userspace " + (folder.path / "bad.py").string()).status, 0);
}

TEST_F(Halcompile, InstallsWhereItIsTold) {
    const std::string to = folder.path.string();
    ::setenv("RTLIB_DIR", (to + "/rt").c_str(), 1);
    ::setenv("EMC2_HOME", (to + "/home").c_str(), 1);
    const Outcome done = halcompile("--install " + corpus("gain.comp") + " " + corpus("usrcount.comp"));
    ::unsetenv("RTLIB_DIR");
    ::unsetenv("EMC2_HOME");
    EXPECT_EQ(done.status, 0) << done.text;
    for (const char *file :
         {"/rt/gain.so", "/home/bin/usrcount", "/home/man/man9/gain.9", "/home/man/man1/usrcount.1"}) {
        EXPECT_NE(done.text.find("halcompile: installed " + to + file + "\n"), std::string::npos)
            << done.text;
    }
    EXPECT_EQ(::access((to + "/rt/gain.so").c_str(), R_OK), 0);
    EXPECT_EQ(fs::status(to + "/rt/gain.so").permissions() & fs::perms::owner_exec, fs::perms::none);
    EXPECT_EQ(::access((to + "/home/bin/usrcount").c_str(), X_OK), 0);
    EXPECT_EQ(::access((to + "/home/man/man9/gain.9").c_str(), R_OK), 0);
    EXPECT_EQ(::access((to + "/home/man/man1/usrcount.1").c_str(), R_OK), 0);
}

TEST_F(Halcompile, ThePageOfTheLanguage) {
    std::ifstream page(std::string(MW_CORPUS) + "/../../../docs/integrator/hal/comp.md");
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

TEST_F(Halcompile, TheMakefileLinksSeveralFiles) {
    if (run("make --version").status != 0) {
        GTEST_SKIP() << "make is not installed";
    }
    std::ofstream(folder.path / "one.c")
        << "#include \"rtapi_app.h\"\n#include \"hal.h\"\nint two(void);\nstatic int id;\n"
           "int shown(void) { return two(); }\nEXPORT_SYMBOL(shown);\n"
           "int rtapi_app_main(void) { id = hal_init(\"pair\"); hal_ready(id); "
           "return id < 0 ? id : 0; }\nvoid rtapi_app_exit(void) { hal_exit(id); }\n";
    std::ofstream(folder.path / "two.c") << "int two(void);\nint two(void) { return 22; }\n";
    std::ofstream(folder.path / "Makefile")
        << "obj-m := pair.o\npair-objs := one.o two.o\n"
           "include $(shell $(HALCOMPILE) --print-modinc)\n"
           "viewer: viewer.c\n\t$(CC) -o $@ $(EXTRA_CFLAGS) -URTAPI -U__MODULE__ "
           "-DULAPI $< -Wl,-rpath,$(LIBDIR) -L$(LIBDIR) -llinuxcnchal\n";
    std::ofstream(folder.path / "viewer.c")
        << "#include \"hal.h\"\nint main(void) { return hal_init(\"v\") == -2; }\n";
    const Outcome done =
        run("make -C " + folder.path.string() + " HALCOMPILE=" + std::string(MW_BIN_DIR) + "/halcompile");
    ASSERT_EQ(done.status, 0) << done.text;
    const Outcome program = run("make -C " + folder.path.string() + " HALCOMPILE=" + std::string(MW_BIN_DIR) +
                                "/halcompile viewer");
    ASSERT_EQ(program.status, 0) << program.text;
    EXPECT_EQ(run("env MILLWRIGHT_INSTANCE=nobody " + (folder.path / "viewer").string()).status, 1);
    ASSERT_EQ(load_only("pair"), "ok");
    EXPECT_NE(host->loader().find_symbol("shown"), nullptr);
    EXPECT_EQ(host->loader().find_symbol("two"), nullptr);
}

TEST_F(Halcompile, ErrorsPointAtTheComponentFile) {
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
