// SPDX-License-Identifier: GPL-2.0-or-later
// The interpreter of a machine with its parameters, and the queue that it writes.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"
#include "machine/task/run/block_search.hh"
#include "machine/task/run/canon_switch.hh"
#include "machine/task/run/modal_code_history.hh"
#include "machine/task/run/reader_call.hh"
#include "machine/task/run/start_record.hh"
#include "machine/task/run/task_canon.hh"
#include "machine/task/sequencer/sequencer.hh"

namespace mw::task {

struct KeptState {
    std::shared_ptr<const gcode::Interpreter::Snapshot> modes;
    std::optional<gcode::MachineFrame> frame;
};

/// One thread. step(), execute(), open() and step_search() take as long as files and scripts do: meanwhile
/// another thread may have task (LongCall), which uses call() alone.
class ProgramReader {
  public:
    struct Setup {
        gcode::LengthUnits units = gcode::LengthUnits::MM;
        ToolChangePlace tool_change_place;
        std::string parameter_file;  ///< empty: parameters live in memory only
        bool isToolChangeWithSpindleOn = false;
        std::string plugin;  ///< [TASK]INTERPRETER: a shared object; empty: RS-274/NGC
        gcode::Settings interpreter;
    };
    /// What a program may ask; all must outlive the reader.
    struct Sources {
        gcode::World &world;
        gcode::ToolSource &tools;
        gcode::ParameterSource &parameters;
    };
    ProgramReader(const Sources &sources, Setup setup);

    /// Opens the plug-in and reads the parameter file. Errors name file, line and column.
    Result<> load();
    Result<> save_parameters() const;
    /// What the parameter file is to have; empty where a plug-in reads programs.
    std::string parameter_text() const;
    /// Null where a plug-in reads programs.
    gcode::Interpreter *gcode() const { return rs274_; }
    /// The world shows the machine as it is now; the position is the program's from here.
    void synch(const geometry::Pose &position);
    /// Reads the program from its first line on. An error says what is wrong with the file.
    Result<> open(const std::string &path);
    // One step of the interpreter: the next line of the program, or a line of MDI.
    gcode::Step step();
    gcode::Step execute(std::string_view line);
    /// All that was read is executed; from here on the machine may read ahead.
    void begin_history();
    /// The machine has reached what step `read` of the interpreter asked for (Item::read).
    void mark_executed(std::uint64_t read);
    /// Once a cycle: what the sequencer has come to is executed; where nothing waits, all is.
    void follow(const Sequencer &sequencer);
    /// The one under way, for the thread that has task meanwhile.
    ReaderCall &call() { return call_; }
    /// Steps that are read and not executed, those that ask the machine for nothing included.
    std::size_t count_ahead() const { return frames_ahead_.size(); }
    std::uint64_t executed() const { return executed_; }
    /// Modal codes as of there.
    gcode::ActiveCodes executed_codes() const;
    /// Forgets what was read ahead: modes, offsets and parameters are those of the block that is executed.
    void return_to_executed();
    /// Announces the modes and offsets again: displays and motion follow them.
    void announce() { interp_->announce(); }
    /// The result of a probe, as a line of the file of (probeopen); empty when it has not tripped.
    std::string probe_line() const;

    // A start elsewhere than at the first line of the program that is open (docs/user/run_from_line.md). The
    // machine has been synched.
    Result<> begin_search(int line);
    /// The same at a block of a program that has begun as `record` says, on a machine that has come up since.
    struct LostPlace {
        std::uint32_t block = 0;
        std::optional<std::uint64_t> calls;  ///< checksum; nothing: it is not compared
    };
    Result<> begin_recovery(StartRecord record, const LostPlace &place);
    /// Modes and parameters as they are, for begin_recovery(); an error says why they cannot be told.
    Result<> keep_start(StartRecord &record) const;
    /// What the program has asked for is counted from here on.
    void begin_marks();
    /// Since then: what cannot be calculated again, empty for nothing.
    std::string take_doubt();
    /// Of the main program: that was read last, or that has called.
    int main_line() const;
    BlockSearch::Outcome step_search(int lines);
    /// nullptr: there is none.
    const BlockSearch *search() const { return search_.get(); }
    /// What a recovery calculates with.
    const StartRecord &recorded() const { return recorded_->record(); }
    /// The program goes on from the place that was found.
    void accept_search();
    /// Modes, parameters and offsets are what they were before it.
    void cancel_search();

    /// The codes of the block that was read last, and of those before it since begin_codes().
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
    gcode::Interpreter *rs274_ = nullptr;    ///< the same; null: a plug-in
    std::optional<RecordedWorld> recorded_;  ///< what a recovery calculates with
    std::unique_ptr<BlockSearch> search_;
    std::uint64_t script_calls_ = 0;  ///< that are known
    KeptState kept_;                  ///< as before the search
    // What an abort returns to; the interpreter has the rest of it.
    gcode::MachineFrame executed_frame_;
    std::deque<FrameAfter> frames_ahead_;
    std::uint64_t executed_ = 0;
    ReaderCall call_;
};

}  // namespace mw::task
