// SPDX-License-Identifier: GPL-2.0-or-later
// Runs power cuts by seed and continues from its log.
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "base/options/command_line.hh"
#include "power_cut/judge.hh"

namespace {

struct Words {
    int first = 1, count = 100;
    std::string log;
    mw::options::Words rest;

    mw::options::CommandLine line() {
        mw::options::CommandLine line("power_cut [options]",
                                      "Cuts the power of a mill in the middle of random programs, in virtual "
                                      "time, and judges what it offers then.\n");
        line.number("--first", "SEED", "1 without it", first, 0, INT32_MAX);
        line.number("--count", "N", "seeds; 100 without it", count, 1, INT32_MAX);
        line.text("--log", "FILE", "seeds in this log are not run again", log);
        line.rest(rest);
        return line;
    }
};

std::set<int> seeds_in(const std::string &path) {
    std::set<int> seeds;
    std::ifstream in(path);
    for (std::string line; std::getline(in, line);) {
        int seed = 0;
        if (std::istringstream(line) >> seed) {
            seeds.insert(seed);
        }
    }
    return seeds;
}

}  // namespace

int main(int argc, char **argv) {
    Words words;
    const std::vector<std::string> given(argv + 1, argv + argc);
    if (const auto parsed = words.line().parse(given); !parsed.has_value() || !words.rest.empty()) {
        std::fputs(words.line().help().c_str(), stderr);
        return 2;
    }
    const std::set<int> known = seeds_in(words.log);
    std::ofstream log(words.log, std::ios::app);
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("mw_power_cut_{}", ::getpid());
    std::map<std::string, int> kinds;
    int bad = 0, latest_ms = 0;
    for (int seed = words.first; seed < words.first + words.count; ++seed) {
        if (known.contains(seed)) {
            continue;
        }
        const auto verdict =
            mw::power_cut::judge_power_cut(static_cast<std::uint64_t>(seed), folder / std::to_string(seed));
        const std::string result = verdict.trouble.empty() ? verdict.kind : "BAD " + verdict.trouble;
        log << seed << ' ' << verdict.late_ms << ' ' << result << std::endl;
        ++kinds[result];
        bad += verdict.trouble.empty() ? 0 : 1;
        latest_ms = std::max(latest_ms, verdict.late_ms);
        std::filesystem::remove_all(folder / std::to_string(seed));
    }
    std::filesystem::remove_all(folder);
    for (const auto &[kind, times] : kinds) {
        fmt::print("{:6} {}\n", times, kind);
    }
    fmt::print("{} bad; the offered block began at most {} ms of cutting before the tool's\n", bad,
               latest_ms);
    return bad == 0 ? 0 : 1;
}
