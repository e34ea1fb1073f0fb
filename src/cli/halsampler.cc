// SPDX-License-Identifier: GPL-2.0-or-later
// halsampler [-c CHANNEL] [-n COUNT] [-t] [FILE]: prints what the component sampler has collected.
#include <unistd.h>

#include "cli/arguments.hh"
#include "cli/stream_main.hh"
#include "hal_tools/stream/programs.hh"

namespace {

constexpr const char *USAGE =
    "usage: halsampler [-c CHANNEL] [-n COUNT] [-t] [FILE]\n"
    "  prints the samples of the component sampler, a line each\n"
    "  -c  queue to read (0)     -n  samples to read, then end     -t  number them\n";

}  // namespace

int main(int argc, char **argv) {
    const std::vector<std::string> first = mw::cli::arguments(argc, argv);
    if (!first.empty() && first[0] == "-h") {
        std::fputs(USAGE, stdout);
        return 0;
    }
    mw::hal::stream_tools::SamplerOptions options;
    for (int option = 0; (option = getopt(argc, argv, "c:n:t")) != -1;) {
        long value = 0;
        switch (option) {
        case 'c':
        case 'n':
            if (!mw::cli::parse_count("halsampler", optarg, value)) {
                return 1;
            }
            if (option == 'n') {
                options.count = value;
            } else {
                options.channel = static_cast<int>(value);
            }
            break;
        case 't': options.isTagged = true; break;
        default: std::fputs(USAGE, stderr); return 1;
        }
    }
    if (optind < argc) {
        options.file = argv[optind];
    }
    return mw::cli::run_attached(
        "halsampler", [&](auto &stop) { return mw::hal::stream_tools::run_sampler(options, stop); });
}
