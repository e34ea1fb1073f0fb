// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/run/program_reader.hh"

#include <map>

#include <fmt/format.h>

#include "interp/plugin.hh"

namespace mw::task {

ProgramReader::ProgramReader(const Sources &sources, Setup setup)
    : sources_(sources), setup_(std::move(setup)), canon_(queue_, setup_.tool_change_place),
      switch_({canon_, sources.world, sources.tools, sources.parameters,
               [this](const SearchMachine &search) {
                   canon_.set_blocks(search.blocks());
                   canon_.set_position(search.snapshot().position);
                   canon_.marks().begin(search.sum());
               }}),
      frame_(switch_, setup_.units) {
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

std::string ProgramReader::parameter_text() const {
    return rs274_ != nullptr ? rs274_->parameter_text() : std::string();
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

Result<> ProgramReader::begin_recovery(StartRecord record, const LostPlace &place) {
    if (rs274_ == nullptr) {
        return fail("only programs in G-code (RS-274/NGC) can be gone on with", {},
                    "[TASK]INTERPRETER names another language");
    }
    const auto modes = rs274_->unpack_kept(record.interpreter);
    if (!modes.has_value()) {
        return std::unexpected(modes.error());
    }
    kept_ = rs274_->keep();
    kept_frame_ = frame_;
    rs274_->restore(**modes);
    if (!frame_.unpack(record.frame)) {
        cancel_search();
        return fail("coordinates cannot be read");
    }
    recorded_.emplace(RecordedWorld::Real{sources_.world, sources_.tools}, std::move(record));
    const SearchMachine::Real real{*recorded_, *recorded_, sources_.parameters, setup_.tool_change_place,
                                   setup_.isToolChangeWithSpindleOn};
    search_ = std::make_unique<BlockSearch>(
        *rs274_, switch_, real, BlockSearch::Block{place.block, place.calls, recorded_->record().calls()});
    return {};
}

Result<> ProgramReader::keep_start(StartRecord &record) const {
    if (rs274_ == nullptr) {
        return fail("it is in another language than G-code");
    }
    auto packed = rs274_->pack_kept();
    if (!packed.has_value()) {
        return std::unexpected(packed.error());
    }
    record.interpreter = std::move(*packed);
    record.frame = frame_.pack();
    record.offsets = canon_.offsets().value_or(interp::UseOffsets{});
    record.tool_offset.offset = canon_.tool_offset().value_or(geom::Pose{});
    return {};
}

void ProgramReader::begin_marks() {
    canon_.marks().begin({});
    static_cast<void>(take_doubt());
}

int ProgramReader::main_line() const {
    const bool isInCall = rs274_ != nullptr && interp_->call_level() > 0;
    return isInCall ? rs274_->next_line().main_line : interp_->line();
}

std::string ProgramReader::take_doubt() {
    std::string doubt = switch_.doubt();
    switch_.forget_doubt();
    const std::uint64_t calls = rs274_ != nullptr ? rs274_->count_script_calls() : 0;
    if (calls != script_calls_) {
        script_calls_ = calls;
        doubt = "what Python has done";
    }
    return doubt;
}

void ProgramReader::accept_search() {
    const std::map<int, interp::ToolEntry> on_their_way = search_->tool_entries();
    if (!switch_.isPassing()) {
        canon_.set_blocks(search_->blocks_before());
        canon_.set_position(search_->found().position);
        canon_.marks().begin(search_->sum());
    }
    search_.reset();
    recorded_.reset();
    kept_.reset();
    rs274_->know_tools(on_their_way);
}

void ProgramReader::cancel_search() {
    search_.reset();
    recorded_.reset();
    queue_.clear();
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
