// SPDX-License-Identifier: GPL-2.0-or-later
// halstreamer [-c CHANNEL] [FILE]: sends lines of values to the component streamer.
#include "hal/tools/stream/programs.hh"
#include "programs/mains/stream_main.hh"

namespace {

constexpr const char *USAGE =
    "usage: halstreamer [-c CHANNEL] [FILE]\n"
    "  sends lines of values (from FILE or standard input) to the component streamer\n"
    "  -c  queue to write (0)\n";

}  // namespace

int main(int argc, char **argv) {
    constexpr mw::options::KnownLetter KNOWN[] = {{'c', "a queue"}, {'h'}};
    mw::hal::stream_tools::StreamerOptions options;
    const auto read = mw::programs::read_stream_words(
        "halstreamer", {argv + 1, argv + argc}, KNOWN, USAGE,
        [&options](char, long number) { options.channel = static_cast<int>(number); });
    if (!read.words.has_value()) {
        return read.status;
    }
    options.file = read.words->empty() ? "" : read.words->front();
    return mw::programs::run_attached(
        "halstreamer", [&](auto &stop) { return mw::hal::stream_tools::run_streamer(options, stop); });
}
