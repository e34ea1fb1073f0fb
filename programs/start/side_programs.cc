// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/start/side_programs.hh"

#include <algorithm>

namespace mw::programs {

void SidePrograms::step(std::int64_t now_ns, diagnostics::Sink &sink) {
    if (commands_.empty() || now_ns < start_ns_) {
        return;
    }
    for (const std::string &command : commands_) {
        // The command may contain quotes and variables, so a shell parses it and is then replaced by the
        // program.
        auto started = DisplayProgram::start({"/bin/sh", "-c", "exec " + command}, ini_);
        if (started.has_value()) {
            running_.push_back(std::move(*started));
        } else {
            sink.error("[APPLICATIONS]APP = " + command + ": " + started.error().str());
        }
    }
    commands_.clear();
}

void SidePrograms::ask_to_end() {
    for (DisplayProgram &program : running_) {
        program.ask_to_end();
    }
}

bool SidePrograms::haveEnded() {
    return std::all_of(running_.begin(), running_.end(),
                       [](DisplayProgram &program) { return program.end().has_value(); });
}

void SidePrograms::kill() {
    running_.clear();
}

}  // namespace mw::programs
