// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/run/program_reader.hh"

#include <fmt/format.h>

#include "interp/plugin.hh"

namespace mw::task {

ProgramReader::ProgramReader(const Sources &sources, Setup setup)
    : sources_(sources), setup_(std::move(setup)), canon_(queue_, setup_.tool_change_place),
      switch_({canon_, sources.world, sources.tools, sources.parameters}), frame_(switch_, setup_.units) {
    // A machine runs its programs: #<_task>, self.task of scripts, and M99 in the main program begins it
    // again.
    setup_.interpreter.isTask = true;
    auto rs274 = std::make_unique<interp::Interpreter>(frame_, switch_, switch_, switch_, setup_.interpreter);
    rs274_ = rs274.get();
    interp_ = std::move(rs274);
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
        rs274_ = nullptr;
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

Result<> ProgramReader::begin_search(int line) {
    if (rs274_ == nullptr) {
        return fail("only programs in G-code (RS-274/NGC) can begin at a line", {},
                    "[TASK]INTERPRETER names another language");
    }
    kept_ = rs274_->keep();
    kept_frame_ = frame_;
    const SearchMachine::Real real{sources_.world, sources_.tools, sources_.parameters,
                                   setup_.tool_change_place, setup_.isToolChangeWithSpindleOn};
    search_ = std::make_unique<BlockSearch>(*rs274_, switch_, real, line);
    return {};
}

void ProgramReader::accept_search() {
    canon_.set_blocks(search_->blocks_before());
    canon_.set_position(search_->found().position);
    search_.reset();
    kept_.reset();
}

void ProgramReader::cancel_search() {
    search_.reset();
    interp_->abort();
    rs274_->restore(*kept_);
    frame_ = *kept_frame_;
    kept_.reset();
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
