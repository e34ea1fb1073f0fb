// SPDX-License-Identifier: GPL-2.0-or-later
// millwright commission: from a description of a machine to the first cut, by commands.
#include <array>
#include <cstdio>

#include <fmt/format.h>

#include "base/text.hh"
#include "programs/commands.hh"
#include "programs/commission/parts.hh"

namespace mw::programs {
namespace {

struct Part {
    const char *name;
    int (*run)(const std::vector<std::string> &words);
    const char *help;
};

constexpr std::array PARTS{
    Part{"find", commission::command_find, "lists boards, ports and pendants of this computer"},
    Part{"describe", commission::command_describe,
         "prints the questions about a machine, with the reason of each preset"},
    Part{"write", commission::command_write, "writes the files of a machine, also again with other answers"},
    Part{"check", commission::command_check,
         "checks inputs, directions, scales, homing and spindle at the machine"},
    Part{"tune", commission::command_tune, "tunes servo loops, maximum speeds and accelerations"},
    Part{"report", commission::command_report, "prints the report for acceptance"},
};

void show_help() {
    fmt::print("usage: millwright commission PART [arguments]\n\n");
    for (const Part &part : PARTS) {
        fmt::print("  {:<9} {}\n", part.name, part.help);
    }
    fmt::print("\n`millwright commission PART --help` describes a part.\n");
}

}  // namespace

int command_commission(const std::vector<std::string> &words) {
    if (words.empty() || words[0] == "--help" || words[0] == "-h") {
        show_help();
        return words.empty() ? 2 : 0;
    }
    for (const Part &part : PARTS) {
        if (words[0] == part.name) {
            return part.run({words.begin() + 1, words.end()});
        }
    }
    std::vector<std::string> names;
    for (const Part &part : PARTS) {
        names.emplace_back(part.name);
    }
    const std::string near = nearest_name(words[0], names);
    fmt::print(stderr, "millwright commission: unknown part '{}'{}\n", printable(words[0]),
               near.empty() ? "" : "; did you mean " + near + "?");
    return 2;
}

}  // namespace mw::programs
