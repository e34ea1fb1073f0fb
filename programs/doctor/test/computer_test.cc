// SPDX-License-Identifier: GPL-2.0-or-later
// The reports about computers and their latency. Requirement A5.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "programs/doctor/examine.hh"
#include "programs/doctor/latency.hh"
#include "programs/doctor/system.hh"

namespace mw::doctor {
namespace {

namespace fs = std::filesystem;

/// A folder that replaces / of another computer.
class Computer {
  public:
    Computer() : root_(fs::temp_directory_path() / ("doctor-" + std::to_string(::getpid()))) {}
    Computer(const Computer &) = delete;
    Computer &operator=(const Computer &) = delete;
    ~Computer() { fs::remove_all(root_); }

    void has(const std::string &path, const std::string &text) {
        fs::create_directories((root_.string() + path).substr(0, (root_.string() + path).rfind('/')));
        std::ofstream(root_.string() + path) << text << '\n';
    }
    /// All findings, one line each.
    std::string findings() const {
        diagnostics::Sink sink;
        examine_system(root_.string(), "/bin/true", sink);
        std::string text;
        for (const diagnostics::Diagnostic &finding : sink.all()) {
            text += finding_line(finding) + '\n';
        }
        return text;
    }

  private:
    fs::path root_;
};

TEST(DoctorTest, anOrdinaryComputerIsWarnedOf) {
    Computer computer;
    computer.has("/proc/cpuinfo", "flags : fpu hypervisor lm");
    computer.has("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
    computer.has("/sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet");
    const std::string text = computer.findings();
    for (const char *part : {"no PREEMPT_RT", "linux-image-rt", "virtual machine", "'powersave'", "hpet"}) {
        EXPECT_NE(text.find(part), text.npos) << part << " in\n" << text;
    }
}

TEST(DoctorTest, aRealtimeComputerHasNothingAgainstIt) {
    Computer computer;
    computer.has("/sys/kernel/realtime", "1");
    computer.has("/proc/cpuinfo", "flags : fpu lm");
    computer.has("/sys/devices/system/cpu/isolated", "1");
    computer.has("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance");
    computer.has("/sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc");
    const std::string text = computer.findings();
    EXPECT_NE(text.find("note: kernel"), text.npos) << text;
    for (const char *part : {"PREEMPT_RT: its", "isolated", "governed", "virtual machine", "clock of"}) {
        EXPECT_EQ(text.find(part), text.npos) << part << " in\n" << text;
    }
}

hal::view::LatencyFigures figures(std::int64_t period_ns, std::int64_t jitter_ns) {
    hal::view::LatencyFigures f;
    f.name = "servo";
    f.period_ns = period_ns;
    f.intervals = 10000;
    f.min_ns = period_ns - jitter_ns;
    f.max_ns = period_ns + jitter_ns;
    return f;
}

std::string judged(const hal::view::LatencyFigures &f) {
    diagnostics::Sink sink;
    judge_latency(f, sink);
    return sink.all().size() == 1 ? finding_line(sink.all()[0]) : "not one finding";
}

TEST(DoctorTest, latencyIsHeldAgainstThePeriod) {
    EXPECT_NE(judged(figures(1'000'000, 40'000)).find("note: thread servo of 1000.0 us"), std::string::npos);
    EXPECT_NE(judged(figures(1'000'000, 40'000)).find("maximum deviation 40.0 us"), std::string::npos);
    EXPECT_NE(judged(figures(25'000, 15'000)).find("warning"), std::string::npos);
    EXPECT_NE(judged(figures(25'000, 15'000)).find("a period of 100000 ns"), std::string::npos);
    EXPECT_NE(judged(figures(1'000'000, 1'200'000)).find("misses its period"), std::string::npos);
    // Ten milliseconds is not a possible period for a machine, so no period is proposed.
    EXPECT_EQ(judged(figures(1'000'000, 9'000'000)).find("a period of"), std::string::npos);
    hal::view::LatencyFigures none = figures(1'000'000, 0);
    none.intervals = 0;
    EXPECT_NE(judged(none).find("it has not run"), std::string::npos);
}

TEST(DoctorTest, aFindingIsOneLine) {
    const std::string line =
        finding_line({diagnostics::Severity::ERROR, {"two\nlines", {"m.ini", 3, 7}, "do it"}, {}, "text"});
    EXPECT_EQ(line, "m.ini:3:7: error: two lines (do it)");
    EXPECT_EQ(finding_line({diagnostics::Severity::NOTE, {"all is well"}}), "system: note: all is well");
}

}  // namespace
}  // namespace mw::doctor
