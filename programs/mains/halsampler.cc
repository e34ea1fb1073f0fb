// SPDX-License-Identifier: GPL-2.0-or-later
// halsampler [-c CHANNEL] [-n COUNT] [-t] [FILE]: prints the data collected by the component sampler.
#include "hal/tools/stream/programs.hh"
#include "programs/mains/stream_main.hh"

namespace {

constexpr const char *USAGE =
    "usage: halsampler [-c CHANNEL] [-n COUNT] [-t] [FILE]\n"
    "  prints the samples of the component sampler, a line each\n"
    "  -c  queue to read (0)     -n  samples to read, then end     -t  number them\n";

}  // namespace

int main(int argc, char **argv) {
    constexpr mw::options::KnownLetter KNOWN[] = {{'c', "a queue"}, {'n', "a number"}, {'t'}, {'h'}};
    mw::hal::stream_tools::SamplerOptions options;
    const auto read = mw::programs::read_stream_words("halsampler", {argv + 1, argv + argc}, KNOWN, USAGE,
                                                      [&options](char letter, long number) {
                                                          switch (letter) {
                                                          case 'c':
                                                              options.channel = static_cast<int>(number);
                                                              break;
                                                          case 'n': options.count = number; break;
                                                          default: options.tagged = true; break;
                                                          }
                                                      });
    if (!read.words.has_value()) {
        return read.status;
    }
    options.file = read.words->empty() ? "" : read.words->front();
    return mw::programs::run_attached(
        "halsampler", [&](auto &stop) { return mw::hal::stream_tools::run_sampler(options, stop); });
}
