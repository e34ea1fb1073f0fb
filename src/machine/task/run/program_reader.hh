// SPDX-License-Identifier: GPL-2.0-or-later
// The interpreter of a machine with its parameters, and the queue to which it writes.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/interpreter_state.hh"
#include "machine/task/run/block_search.hh"
#include "machine/task/run/canon_switch.hh"
#include "machine/task/run/modal_code_history.hh"
#include "machine/task/run/reader_call.hh"
#include "machine/task/run/start_record.hh"
#include "machine/task/run/task_canon.hh"
#include "machine/task/sequencer/sequencer.hh"

namespace mw::task {

struct KeptState {
    std::unique_ptr<const gcode::InterpreterState> modes;
    std::optional<gcode::MachineFrame> frame;
};

/// All calls come from one thread. step(), execute(), open() and step_search() may wait for files and
/// scripts. Meanwhile another thread may use task (LongCall); of the reader it uses only call().
class ProgramReader {
  public:
    struct Setup {
        gcode::LengthUnits units = gcode::LengthUnits::MM;
        ToolChangePlace tool_change_place;
        std::string parameter_file;  ///< empty: parameters are only in memory
        bool tool_change_with_spindle_on = false;
        std::string plugin;  ///< [TASK]INTERPRETER: a shared object; empty: RS-274/NGC
        gcode::Settings interpreter;
    };
    /// Data sources of programs; all must outlive the reader.
    struct Sources {
        gcode::World &world;
        gcode::ToolSource &tools;
        gcode::ParameterSource &parameters;
    };
    ProgramReader(const Sources &sources, Setup setup);

    /// Opens the plug-in and reads the parameter file. Errors name file, line and column.
    Result<> load();
    Result<> save_parameters() const;
    /// Content of the parameter file; empty with a plug-in.
    std::string parameter_text() const;
    /// The RS-274/NGC interpreter; null with a plug-in.
    gcode::Interpreter *gcode() const { return rs274_; }
    /// Updates the world with the machine's state; the program's position becomes `position`.
    void synch(const geometry::Pose &position);
    /// Opens a program at its first line. An error describes the problem with the file.
    Result<> open(const std::string &path);
    // One step of the interpreter: the next line of the program, or a line of MDI.
    gcode::Step step();
    gcode::Step execute(std::string_view line);
    /// Called when everything read is executed; from now on the interpreter may read ahead.
    void begin_history();
    /// Called when the machine has reached the calls of step `read` of the interpreter (Item::read).
    void mark_executed(std::uint64_t read);
    /// Called once in each cycle: steps that the sequencer has reached are executed; all steps if nothing
    /// waits.
    void follow(const Sequencer &sequencer);
    /// The current call, for the thread that meanwhile uses task.
    ReaderCall &call() { return call_; }
    /// Steps that are read and not executed, including those without calls.
    std::size_t count_ahead() const { return frames_ahead_.size(); }
    std::uint64_t executed() const { return executed_; }
    /// Modal codes of the executed step.
    gcode::ActiveCodes executed_codes() const;
    /// Discards the blocks read ahead: modes, offsets and parameters become those of the executed block.
    void return_to_executed();
    /// Announces the modes and offsets again, for displays and motion.
    void announce() { interp_->announce(); }
    /// The result of a probe, as a line of the (probeopen) file; empty when it has not tripped.
    std::string probe_line() const;

    // Starts a search for a line of the open program (docs/user/run_from_line.md). The reader must have been
    // synched.
    Result<> begin_search(int line);
    /// As begin_search(), for a block of a program that began with `record`, on a machine that was restarted
    /// later.
    struct LostPlace {
        std::uint32_t block = 0;
        std::optional<std::uint64_t> calls;  ///< expected checksum; nothing: not compared
    };
    Result<> begin_recovery(StartRecord record, const LostPlace &place);
    /// Stores the current modes and parameters for begin_recovery(); an error names a state that cannot be
    /// stored.
    Result<> keep_start(StartRecord &record) const;
    /// Starts the checksums of the program's calls.
    void begin_marks();
    /// A value read since the last call that cannot be calculated again; empty: none.
    std::string take_doubt();
    /// Last line read in the main program, or its line with the current call.
    int main_line() const;
    BlockSearch::Outcome step_search(int lines);
    /// null: no search
    const BlockSearch *search() const { return search_.get(); }
    /// State used by a recovery.
    const StartRecord &recorded() const { return recorded_->record(); }
    /// The program continues from the position that was found.
    void accept_search();
    /// Restores modes, parameters and offsets from before the search.
    void cancel_search();

    /// Stores the codes of the last block, and of earlier ones since begin_codes().
    void note_codes() { codes_.note(canon_.blocks(), interp_->active_codes()); }
    void begin_codes() { codes_.clear(); }
    const ModalCodeHistory &codes() const { return codes_; }

    gcode::ProgramInterpreter &interpreter() { return *interp_; }
    const gcode::ProgramInterpreter &interpreter() const { return *interp_; }
    TaskCanon &canon() { return canon_; }
    const TaskCanon &canon() const { return canon_; }
    ItemQueue &queue() { return queue_; }

  private:
    struct FrameAfter {
        std::uint64_t read = 0;
        gcode::MachineFrame frame;
    };
    void keep_place(const gcode::BlockRef &block);
    void note_read();

    Sources sources_;
    Setup setup_;
    ItemQueue queue_;
    TaskCanon canon_;
    ModalCodeHistory codes_;
    CanonSwitch switch_;
    gcode::MachineFrame frame_;
    std::unique_ptr<gcode::ProgramInterpreter> interp_;
    gcode::Interpreter *rs274_ = nullptr;    ///< the same object as the interpreter; null: a plug-in
    std::optional<RecordedWorld> recorded_;  ///< world used by a recovery
    std::unique_ptr<BlockSearch> search_;
    std::uint64_t script_calls_ = 0;  ///< number of known script calls
    KeptState kept_;                  ///< state before the search
    // State to which an abort returns; the interpreter has the other parts.
    gcode::MachineFrame executed_frame_;
    std::deque<FrameAfter> frames_ahead_;
    std::uint64_t executed_ = 0;
    ReaderCall call_;
};

}  // namespace mw::task
