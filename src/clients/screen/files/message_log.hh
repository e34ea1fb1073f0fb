// SPDX-License-Identifier: GPL-2.0-or-later
// [DISPLAY]LOG_FILE: the messages to the operators, one line each.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>
#include <string_view>

#include "base/result.hh"

namespace mw::screen {

/// Blocks during disk access. One thread at a time.
class MessageLog {
  public:
    /// A file that would exceed this size [bytes] is renamed to `path` + ".1", replacing the previous one.
    static constexpr std::uintmax_t MOST_BYTES = 1024 * 1024;

    explicit MessageLog(std::string path, std::uintmax_t most_bytes = MOST_BYTES)
        : path_(std::move(path)), most_bytes_(most_bytes) {}

    /// "2026-11-26 09:30:00 text" in local time; the lines of a longer text are joined by " / ". An error
    /// names the file that cannot be written, and the reason.
    Result<> add(std::time_t when, std::string_view text);

  private:
    std::string path_;
    std::uintmax_t most_bytes_;
};

}  // namespace mw::screen
