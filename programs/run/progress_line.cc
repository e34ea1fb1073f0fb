// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/progress_line.hh"

#include <unistd.h>

#include <cstdio>

#include <fmt/format.h>

#include "base/language/language.hh"
#include "base/output_relay.hh"

namespace mw::programs {

ProgressLine::ProgressLine() : is_terminal_(OutputRelay::isTerminal(STDERR_FILENO)) {}

void ProgressLine::show(const gcode::PreviewProgress &now) {
    constexpr std::chrono::milliseconds EVERY{500};
    const auto time = std::chrono::steady_clock::now();
    if (!is_terminal_ || time - last_ < EVERY) {
        return;
    }
    last_ = time;
    shown_ = true;
    const double seconds = std::chrono::duration<double>(time - begin_).count();
    const double share = now.bytes_in_all > 0
                             ? 100.0 * static_cast<double>(now.bytes) / static_cast<double>(now.bytes_in_all)
                             : 0;
    const std::string text =
        fmt::format("reading: {:3.0f} % of the file, {} blocks, {:.0f} s", share, now.blocks, seconds);
    fmt::print(stderr, "\r{}\033[K", language::shown(text));
}

void ProgressLine::clear() {
    if (shown_) {
        fmt::print(stderr, "\r\033[K");
        shown_ = false;
    }
}

}  // namespace mw::programs
