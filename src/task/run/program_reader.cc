// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/run/program_reader.hh"

#include <fmt/format.h>

#include "interp/plugin.hh"

namespace mw::task {

ProgramReader::ProgramReader(const Sources &sources, Setup setup)
    : sources_(sources), setup_(std::move(setup)), canon_(queue_, setup_.tool_change_place),
      frame_(canon_, setup_.units) {
    // A machine runs its programs: #<_task>, self.task of scripts, and M99 in the main program begins it
    // again.
    setup_.interpreter.isTask = true;
    interp_ = std::make_unique<interp::Interpreter>(frame_, sources_.world, sources_.tools,
                                                    sources_.parameters, setup_.interpreter);
}

Result<> ProgramReader::load() {
    if (!setup_.plugin.empty()) {
        auto opened =
            interp::open_plugin(setup_.plugin, {frame_, sources_.world, sources_.tools, sources_.parameters});
        if (!opened) {
            opened.error().message = "[TASK]INTERPRETER: " + opened.error().message;
            return std::unexpected(opened.error());
        }
        interp_ = std::move(*opened);
    }
    return setup_.parameter_file.empty() ? Result<>{} : interp_->load_parameters(setup_.parameter_file);
}

Result<> ProgramReader::save_parameters() const {
    return setup_.parameter_file.empty() ? Result<>{} : interp_->save_parameters(setup_.parameter_file);
}

void ProgramReader::synch(const geom::Pose &position) {
    canon_.set_position(position);
    frame_.set_position(position);
    interp_->synch();
}

void ProgramReader::drop() {
    interp_->abort();
    interp_->announce();
}

std::string ProgramReader::probe_line() const {
    constexpr int RESULT = 5061, SUCCESS = 5070, AXES = 9;
    std::string line;
    if (interp_->parameter(SUCCESS) == 0.0) {
        return line;
    }
    for (int axis = 0; axis < AXES; ++axis) {
        line += (axis == 0 ? "" : " ") + fmt::format("{:.6f}", interp_->parameter(RESULT + axis));
    }
    return line;
}

}  // namespace mw::task
