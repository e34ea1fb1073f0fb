// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/program_reader.hh"

#include <algorithm>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "gcode/interpreter/plugin.hh"
#include "gcode/interpreter/read_ahead.hh"
#include "gcode/interpreter/scripts/script_stop.hh"

namespace mw::task {
namespace {

/// Scope of a long call into the interpreter.
class Call {
  public:
    enum class Reads : std::uint8_t { NOTHING, A_STEP };

    Call(ProgramReader &reader, Reads reads) : reader_(reader) {
        reader_.call().reads_before = reader_.canon().reads();
        if (reads == Reads::A_STEP) {
            reader_.canon().begin_read();
        }
        reader_.canon().divert(&reader_.call().fresh);
        gcode::script_stop().begin();
        reader_.call().call.begin();
    }
    ~Call() {
        reader_.call().call.end();
        gcode::script_stop().begin();
        reader_.canon().divert(nullptr);
        ItemQueue &fresh = reader_.call().fresh;
        std::move(fresh.begin(), fresh.end(), std::back_inserter(reader_.queue()));
        fresh.clear();
    }
    Call(const Call &) = delete;
    Call &operator=(const Call &) = delete;

  private:
    ProgramReader &reader_;
};

}  // namespace

ProgramReader::ProgramReader(const Sources &sources, Setup setup)
    : sources_(sources), setup_(std::move(setup)), canon_(queue_, setup_.tool_change_place),
      switch_({canon_, sources.world, sources.tools, sources.parameters,
               [this](const SearchMachine &search) {
                   canon_.set_blocks(search.blocks());
                   canon_.set_position(search.snapshot().position);
                   canon_.marks().begin(search.sum());
               }}),
      frame_(switch_, setup_.units), executed_frame_(frame_) {
    // On a machine, #<_task> and self.task of scripts are set, and M99 in the main program restarts it.
    setup_.interpreter.is_task = true;
    auto rs274 = std::make_unique<gcode::Interpreter>(frame_, switch_, switch_, switch_, setup_.interpreter);
    rs274_ = rs274.get();
    interp_ = std::move(rs274);
}

Result<> ProgramReader::load() {
    if (!setup_.plugin.empty()) {
        auto opened =
            gcode::open_plugin(setup_.plugin, {frame_, sources_.world, sources_.tools, sources_.parameters});
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
    return rs274_ != nullptr ? rs274_->read_ahead().parameter_text() : std::string();
}

/// Calls that report the machine's state do not belong to a block read ahead.
void ProgramReader::synch(const geometry::Pose &position) {
    canon_.set_position(position);
    frame_.set_position(position);
    interp_->synch();
    note_read();
    mark_executed(canon_.reads());
}

Result<> ProgramReader::open(const std::string &path) {
    const Call call(*this, Call::Reads::NOTHING);
    return interp_->open(path);
}

BlockSearch::Outcome ProgramReader::step_search(int lines) {
    const Call call(*this, Call::Reads::NOTHING);
    return search_->step(lines);
}

gcode::Step ProgramReader::step() {
    const gcode::Step result = [this] {
        const Call call(*this, Call::Reads::A_STEP);
        return interp_->step();
    }();
    if (rs274_ != nullptr && result == gcode::Step::OK) {
        const std::string &file = rs274_->file();
        const int line = rs274_->line();
        keep_place({file, line, line, rs274_->call_level(), rs274_->line_text(file, line), false});
    }
    note_codes();
    note_read();
    return result;
}

gcode::Step ProgramReader::execute(std::string_view line) {
    const gcode::Step result = [&] {
        const Call call(*this, Call::Reads::A_STEP);
        return interp_->execute(line);
    }();
    if (result == gcode::Step::FILE_END) {
        keep_place({{}, 0, 0, 0, line});
    }
    note_codes();
    note_read();
    return result;
}

/// Gives a block without calls its position in the order of execution.
void ProgramReader::keep_place(const gcode::BlockRef &block) {
    const bool silent = !canon_.isAsking() && !interp_->isMoveHeld();
    if (silent && rs274_ != nullptr && search_ == nullptr && !rs274_->read_ahead().isLineEmpty()) {
        canon_.pass_block(block);
    }
}

/// A move delayed by cutter compensation is executed with the step that releases it, so the changes of that
/// step count from there.
void ProgramReader::note_read() {
    if (rs274_ == nullptr || search_ != nullptr) {
        return;
    }
    const std::uint64_t read = canon_.reads() + (rs274_->isMoveHeld() ? 1 : 0);
    rs274_->read_ahead().note(read);
    frames_ahead_.push_back({read, frame_});
}

void ProgramReader::begin_history() {
    if (rs274_ != nullptr) {
        rs274_->read_ahead().begin();
    }
    executed_ = canon_.reads();
    executed_frame_ = frame_;
    frames_ahead_.clear();
}

void ProgramReader::mark_executed(std::uint64_t read) {
    if (rs274_ == nullptr || search_ != nullptr) {
        return;
    }
    executed_ = std::max(executed_, read);
    rs274_->read_ahead().mark_executed(read);
    for (; !frames_ahead_.empty() && frames_ahead_.front().read <= read; frames_ahead_.pop_front()) {
        executed_frame_ = frames_ahead_.front().frame;
    }
}

void ProgramReader::follow(const Sequencer &sequencer) {
    if (call_.fixed_executed.has_value()) {
        mark_executed(*call_.fixed_executed);
    } else {
        sequencer.isIdle() ? mark_executed(canon_.reads()) : mark_executed(sequencer.place().read);
    }
}

gcode::ActiveCodes ProgramReader::executed_codes() const {
    return rs274_ != nullptr ? rs274_->read_ahead().executed_codes() : interp_->active_codes();
}

void ProgramReader::return_to_executed() {
    call_.fixed_executed.reset();
    if (rs274_ == nullptr) {
        interp_->abort();
        return;
    }
    rs274_->read_ahead().return_to_executed();
    frame_ = executed_frame_;
    begin_history();
}

Result<> ProgramReader::begin_search(int line) {
    if (rs274_ == nullptr) {
        return fail("only programs in G-code (RS-274/NGC) can start from a line", {},
                    "[TASK]INTERPRETER names another language");
    }
    kept_.modes = std::make_unique<gcode::InterpreterState>(rs274_->state());
    kept_.frame = frame_;
    rs274_->read_ahead().stop();
    const SearchMachine::Real real{sources_.world, sources_.tools, sources_.parameters,
                                   setup_.tool_change_place, setup_.tool_change_with_spindle_on};
    search_ = std::make_unique<BlockSearch>(*rs274_, switch_, real, line);
    return {};
}

Result<> ProgramReader::begin_recovery(StartRecord record, const LostPlace &place) {
    if (rs274_ == nullptr) {
        return fail("only programs in G-code (RS-274/NGC) can be continued", {},
                    "[TASK]INTERPRETER names another language");
    }
    const auto modes = rs274_->unpack_state(record.interpreter);
    if (!modes.has_value()) {
        return std::unexpected(modes.error());
    }
    kept_.modes = std::make_unique<gcode::InterpreterState>(rs274_->state());
    kept_.frame = frame_;
    rs274_->read_ahead().stop();
    rs274_->restore(*modes);
    if (!frame_.unpack(record.frame)) {
        cancel_search();
        return fail("coordinates cannot be read");
    }
    recorded_.emplace(RecordedWorld::Real{sources_.world, sources_.tools}, std::move(record));
    const SearchMachine::Real real{*recorded_, *recorded_, sources_.parameters, setup_.tool_change_place,
                                   setup_.tool_change_with_spindle_on};
    search_ = std::make_unique<BlockSearch>(
        *rs274_, switch_, real, BlockSearch::Block{place.block, place.calls, recorded_->record().calls()});
    return {};
}

Result<> ProgramReader::keep_start(StartRecord &record) const {
    if (rs274_ == nullptr) {
        return fail("it is in another language than G-code");
    }
    auto packed = rs274_->pack_state();
    if (!packed.has_value()) {
        return std::unexpected(packed.error());
    }
    record.interpreter = std::move(*packed);
    record.frame = frame_.pack();
    record.offsets = canon_.offsets().value_or(gcode::UseOffsets{});
    record.tool_offset.offset = canon_.tool_offset().value_or(geometry::Pose{});
    return {};
}

void ProgramReader::begin_marks() {
    canon_.marks().begin({});
    static_cast<void>(take_doubt());
}

int ProgramReader::main_line() const {
    const bool in_call = rs274_ != nullptr && interp_->call_level() > 0;
    return in_call ? rs274_->next_line().main_line : interp_->line();
}

std::string ProgramReader::take_doubt() {
    std::string doubt = switch_.doubt();
    switch_.forget_doubt();
    const std::uint64_t calls = rs274_ != nullptr ? rs274_->count_script_calls() : 0;
    if (calls != script_calls_) {
        script_calls_ = calls;
        doubt = "actions of Python code";
    }
    return doubt;
}

void ProgramReader::accept_search() {
    const std::map<int, gcode::ToolEntry> on_their_way = search_->tool_entries();
    if (!switch_.isPassing()) {
        canon_.set_blocks(search_->blocks_before());
        canon_.set_position(search_->found().position);
        canon_.marks().begin(search_->sum());
    }
    search_.reset();
    recorded_.reset();
    kept_.modes.reset();
    rs274_->know_tools(on_their_way);
    begin_history();
}

void ProgramReader::cancel_search() {
    search_.reset();
    recorded_.reset();
    queue_.clear();
    interp_->abort();
    rs274_->restore(*kept_.modes);
    frame_ = *kept_.frame;
    kept_.modes.reset();
    begin_history();
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
