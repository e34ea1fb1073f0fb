// SPDX-License-Identifier: GPL-2.0-or-later
// Compiles components with the program halcompile and loads them into an instance under virtual time.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "hal/core/host.hh"
#include "hal/include/hal.h"
#include "runtime/virtual_scheduler.hh"

namespace mw::hal {
namespace fs = std::filesystem;

/// A folder for compiled files, separate from that of any other test.
struct Folder {
    fs::path path = fs::path(::testing::TempDir()) / ("mw_corpus_" + std::to_string(::getpid()));
    Folder() { fs::create_directories(path); }
    ~Folder() {
        std::error_code ignored;
        fs::remove_all(path, ignored);
    }
};

/// Runs a program to its end; returns its exit status and output.
struct Outcome {
    int status = -1;
    std::string text;
};
inline Outcome run(const std::string &command) {
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

inline Outcome halcompile(const std::string &words) {
    return run(std::string(MW_BIN_DIR) + "/halcompile " + words);
}

inline std::string corpus(const std::string &file) {
    return std::string(MW_CORPUS) + "/" + file;
}

struct Corpus : ::testing::Test {
    Folder folder;
    std::vector<std::string> messages;
    runtime::Log log{runtime::Log::Mode::SYNCHRONOUS,
                     [](void *self, runtime::LogLevel, const char *text) {
                         static_cast<std::vector<std::string> *>(self)->emplace_back(text);
                     },
                     &messages};
    runtime::VirtualScheduler clock;
    std::unique_ptr<LocalHost> host;

    Corpus() {
        InstanceOptions options;
        options.name = "corpus" + std::to_string(::getpid());
        options.isShared = true;
        options.scheduler = &clock;
        options.log = &log;
        auto made = LocalHost::create(options, {folder.path});
        EXPECT_TRUE(made) << made.error().str();
        host = std::move(*made);
        EXPECT_TRUE(hal().threads().create("t", 1'000'000));
    }
    Instance &hal() { return host->hal(); }

    /// Compiles a file of the corpus; returns the messages.
    std::string compile(const std::string &file, const std::string &words = "") {
        const std::string name = fs::path(file).stem();
        const bool isProgram = file.starts_with("usr") || file == "cusr.c" || file.ends_with(".py");
        const Outcome done =
            halcompile("--compile --extra-compile-args='-O1 -g0' -o " + (folder.path / name).string() +
                       (isProgram ? " " : ".so ") + words + " " + corpus(file));
        EXPECT_EQ(done.status, 0) << done.text;
        return done.text;
    }
    /// Compiles and loads a component. Returns "ok" or the error.
    std::string load(const std::string &file, const std::vector<std::string> &args = {}) {
        compile(file);
        return load_only(fs::path(file).stem(), args);
    }
    std::string load_only(const std::string &name, const std::vector<std::string> &args = {}) {
        const auto done = host->load_realtime(name, args);
        return done ? "ok" : done.error().str();
    }
    /// Adds functions to the thread and runs it for some periods.
    void cycle(const std::vector<std::string> &functions, int periods = 1) {
        for (const std::string &function : functions) {
            const auto done = hal().threads().add_function(function, "t");
            EXPECT_TRUE(done) << done.error().str();
        }
        EXPECT_TRUE(hal().threads().start());
        more(periods);
    }
    void more(int periods) { clock.run_until(clock.now_ns() + periods * 1'000'000LL); }
    double number(const std::string &name) {
        const auto value = hal().values().get(name);
        EXPECT_TRUE(value) << name;
        return value ? value->as_number() : -999;
    }
    void set(const std::string &name, const std::string &value) {
        const auto done = hal().values().set(name, std::string_view(value));
        EXPECT_TRUE(done) << done.error().str();
    }
    std::string pins(const std::string &glob) {
        std::string names;
        for (const PinInfo &pin : hal().pins().list(glob)) {
            names += pin.name + " ";
        }
        return names;
    }
};

}  // namespace mw::hal
