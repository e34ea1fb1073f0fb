// SPDX-License-Identifier: GPL-2.0-or-later
// halsampler and halstreamer: between the streams of an instance and lines of text.
#pragma once

#include <csignal>
#include <string>

#include "base/result.hh"

namespace mw::hal::stream_tools {

struct SamplerOptions {
    int channel = 0;
    long count = -1;      ///< samples to read; below 0: until stopped
    bool tagged = false;  ///< each line begins with the number of the sample
    std::string file;     ///< empty: standard output
};

struct StreamerOptions {
    int channel = 0;
    std::string file;  ///< empty: standard input
};

/// Copies samples to text until `count` are read; a gap in their numbers is a line "overrun". Ends early,
/// with an error, when *stop is not zero. Uses the current instance.
Result<> run_sampler(const SamplerOptions &options, volatile std::sig_atomic_t &stop);

/// Copies records to the stream until the end of the input. Reports malformed lines on standard error and
/// skips them.
Result<> run_streamer(const StreamerOptions &options, volatile std::sig_atomic_t &stop);

}  // namespace mw::hal::stream_tools
