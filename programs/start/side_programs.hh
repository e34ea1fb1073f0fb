// SPDX-License-Identifier: GPL-2.0-or-later
// The programs of [APPLICATIONS], which are started some time after the machine and ended with it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "programs/start/display_program.hh"

namespace mw::programs {

/// All calls come from one thread.
class SidePrograms {
  public:
    /// `commands` as in the INI file; they are started at `start_ns`.
    SidePrograms(std::vector<std::string> commands, std::string ini, std::int64_t start_ns)
        : commands_(std::move(commands)), ini_(std::move(ini)), start_ns_(start_ns) {}

    /// Starts the programs at their time. A program that cannot be started is reported, and the others are
    /// started.
    void step(std::int64_t now_ns, diagnostics::Sink &sink);
    void ask_to_end();
    bool haveEnded();
    void kill();

  private:
    std::vector<std::string> commands_;
    std::string ini_;
    std::int64_t start_ns_;
    std::vector<DisplayProgram> running_;
};

}  // namespace mw::programs
