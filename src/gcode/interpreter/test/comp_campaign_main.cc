// SPDX-License-Identifier: GPL-2.0-or-later
// A campaign of random contours under cutter compensation, judged by the disc that the tool sweeps.
// comp_campaign [--kind pockets] --first N --count M --log FILE [--print SEED]: one line per seed in the log;
// seeds in the log are not run again. Status 1 when a contour was gouged, not fully cut, or rejected without
// a reason.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "base/options/command_line.hh"
#include "base/result.hh"
#include "gcode/interpreter/test/comp_judge.hh"
#include "gcode/interpreter/test/comp_pockets.hh"

namespace mw::gcode::test {
namespace {

struct Totals {
    std::size_t contours = 0, corners = 0, failed = 0, refused = 0;
    std::map<std::string, std::size_t> reasons;
    double wanted = 0, reached = 0;
};

void count(const CompVerdict &v, Totals &totals) {
    ++totals.contours;
    totals.corners += v.corners;
    totals.failed += v.fault.empty() ? 0 : 1;
    totals.refused += v.refused.empty() ? 0 : 1;
    totals.wanted += v.wanted;
    totals.reached += v.reached;
    if (!v.refused.empty()) {
        ++totals.reasons[v.refused];
    }
}

std::set<std::string> seeds_in(const std::string &name) {
    std::set<std::string> seeds;
    std::ifstream file(name);
    for (std::string line; std::getline(file, line);) {
        seeds.insert(line.substr(0, line.find(' ')));
    }
    return seeds;
}

int run(unsigned first, unsigned count_of, const std::string &log, bool is_pockets) {
    const std::set<std::string> done = seeds_in(log);
    std::ofstream out(log, std::ios::app);
    Totals totals;
    for (unsigned seed = first; seed < first + count_of; ++seed) {
        if (done.contains(std::to_string(seed))) {
            continue;
        }
        const CompVerdict v =
            is_pockets ? judge_pocket(PocketMaker(seed).make()) : judge_contour(ContourMaker(seed).make());
        count(v, totals);
        out << seed << ' ' << v.corners << ' '
            << (!v.fault.empty()     ? "FAILED " + v.fault
                : !v.refused.empty() ? "refused: " + v.refused
                                     : std::string("ok"))
            << '\n';
    }
    fmt::print("{} {}, {} corners: {} failed, {} rejected ({:.2f} %), {:.6f} of what is reachable cut\n",
               totals.contours, is_pockets ? "pockets" : "contours", totals.corners, totals.failed,
               totals.refused,
               100.0 * static_cast<double>(totals.refused) /
                   static_cast<double>(std::max<std::size_t>(1, totals.contours)),
               totals.wanted > 0 ? totals.reached / totals.wanted : 1.0);
    for (const auto &[reason, times] : totals.reasons) {
        fmt::print("  {} {}\n", times, reason);
    }
    return totals.failed == 0 && out.good() ? 0 : 1;
}

}  // namespace

/// Prints the program, and for each corner its angle and the fraction of each side that the tool cannot
/// reach.
void print_contour(unsigned seed) {
    const CompContour c = ContourMaker(seed).make();
    fmt::print("(tool radius {:.9f}{}{})\n", c.radius, c.crossing ? ", leads over itself" : "",
               c.tight ? ", tight" : "");
    for (std::size_t k = 0; k < c.pieces.size(); ++k) {
        const FlatPiece &before = k == 0 ? c.entry : c.pieces[k - 1];
        const Junction met =
            junction(before, c.pieces[k], c.side * c.radius, tip_tolerance(c), ends_apart(c));
        fmt::print("(line {}: {:.4f} degrees, {:.4f} and {:.4f} taken{})\n", FIRST_LINE + static_cast<int>(k),
                   corner_angle(before, c.pieces[k]) * 180.0 / PI, met.before.share, met.behind.share,
                   met.crossing ? ", crossing" : "");
    }
    fmt::print("{}M2\n", program_of(c));
}

void print_pocket(unsigned seed) {
    fmt::print("{}M2\n", program_of(PocketMaker(seed).make()));
}

}  // namespace mw::gcode::test

int main(int argc, char **argv) {
    std::string log;
    unsigned first = 1, count = 1000;
    std::int64_t printed = -1;
    bool is_pockets = false;
    mw::options::CommandLine line(
        "comp_campaign [--kind pockets] --first N --count M --log FILE\n"
        "       comp_campaign [--kind pockets] --print SEED",
        "One line for each seed in the log; seeds that it has are not run again.\n");
    line.take("--kind", 1, "pockets", "random pockets; without it random contours",
              [&is_pockets](const mw::options::Words &words) -> mw::Result<> {
                  is_pockets = words[0] == "pockets";
                  return is_pockets ? mw::Result<>{} : mw::fail("'" + words[0] + "' is no kind");
              });
    line.number("--first", "N", "seed to begin with (default 1)", first, 0, UINT32_MAX - 1);
    line.number("--count", "M", "so many seeds (default 1000)", count, 0, UINT32_MAX - 1);
    line.text("--log", "FILE", "where the verdicts go", log);
    line.number("--print", "SEED", "print one program", printed, 0, UINT32_MAX - 1);
    const auto parsed = line.parse({argv + 1, argv + argc});
    if (!parsed || (log.empty() && printed < 0)) {
        std::fprintf(stderr, "%s\n%s", parsed ? "--log is missing" : parsed.error().str().c_str(),
                     line.help().c_str());
        return 2;
    }
    if (printed >= 0) {
        const auto seed = static_cast<unsigned>(printed);
        is_pockets ? mw::gcode::test::print_pocket(seed) : mw::gcode::test::print_contour(seed);
        return 0;
    }
    return mw::gcode::test::run(first, count, log, is_pockets);
}
