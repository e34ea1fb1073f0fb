// SPDX-License-Identifier: GPL-2.0-or-later
// halstreamer [-c CHANNEL] [FILE]: feeds lines of values to the component streamer.
#include <unistd.h>

#include "cli/arguments.hh"
#include "cli/stream_main.hh"
#include "hal_tools/stream/programs.hh"

namespace {

constexpr const char *USAGE =
    "usage: halstreamer [-c CHANNEL] [FILE]\n"
    "  sends lines of values (from FILE or standard input) to the component streamer\n"
    "  -c  queue to write (0)\n";

}  // namespace

int main(int argc, char **argv) {
    const std::vector<std::string> first = mw::cli::arguments(argc, argv);
    if (!first.empty() && first[0] == "-h") {
        std::fputs(USAGE, stdout);
        return 0;
    }
    mw::hal::stream_tools::StreamerOptions options;
    for (int option = 0; (option = getopt(argc, argv, "c:")) != -1;) {
        long value = 0;
        if (option != 'c') {
            std::fputs(USAGE, stderr);
            return 1;
        }
        if (!mw::cli::parse_count("halstreamer", optarg, value)) {
            return 1;
        }
        options.channel = static_cast<int>(value);
    }
    if (optind < argc) {
        options.file = argv[optind];
    }
    return mw::cli::run_attached(
        "halstreamer", [&](auto &stop) { return mw::hal::stream_tools::run_streamer(options, stop); });
}
