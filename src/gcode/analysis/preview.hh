// SPDX-License-Identifier: GPL-2.0-or-later
// What a program would do, without doing it: its moves with their places in the source, as a stream.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "gcode/canon/machine_canon.hh"
#include "gcode/interpreter/interpreter.hh"

namespace mw::gcode {

enum class PreviewKind : std::uint8_t {
    RAPID,
    FEED,
    ARC,
    PROBE,
    RIGID_TAP,    ///< to `end` and back to `start`
    DWELL,        ///< `value` [s]
    TOOL_CHANGE,  ///< tool `number` is in the spindle from here on
    STOP,         ///< M0, M1 and M60: motion stands
    PLANNER,      ///< G64 R: from here on planned with jerk limits when `number` is 1, without when 0
};

/// A move, or what stands between moves. Poses are in the coordinates that were asked for.
struct PreviewEvent {
    PreviewKind kind = PreviewKind::RAPID;
    bool isByMachine = false;       ///< a move that the machine makes by itself, at a tool change
    bool isSpindleAwaited = false;  ///< motion stands before this move until the spindle has its speed
    geometry::Pose start, end;      ///< the same for what is no move
    geometry::Pose centre, normal;  ///< of an arc, as in ArcMove
    double angle_rad = 0;
    geometry::MoveSettings settings;  ///< of a move [machine units]
    /// Of the spindle that a move follows, half-way, as programmed (G96 counted). [rev/min]
    double spindle_rpm = 0;
    double value = 0;
    int number = 0;
    int line = 0, sequence = 0, call_level = 0;  ///< as in BlockRef
    std::uint32_t file = 0;                      ///< see Preview::file
    std::uint32_t section = 0;                   ///< see Preview::section
};

enum class PreviewCoordinates {
    MACHINE,  ///< machine units; the controlled point of the machine
    TIP,      ///< the same without the tool offset: where the tool cuts
    PROGRAM,  ///< program units and coordinates, as written
};

/// The machine that a program is interpreted for.
struct PreviewMachine {
    gcode::Settings interpreter;
    gcode::LengthUnits units = gcode::LengthUnits::MM;
    unsigned axis_mask = 0x1ff;
    int spindles = 1;
    bool isBlockDeleteOn = true;
    std::string parameter_file;  ///< read and never written; empty: none
    geometry::Pose position;     ///< where it stands [machine units]
    int tool_in_spindle = 0;
    /// The moves that it makes for a tool change, from a position; none when not set.
    std::function<std::vector<geometry::Pose>(const geometry::Pose &)> tool_change_moves;
};

struct PreviewProgress {
    std::uint64_t blocks = 0, events = 0;
    std::uint64_t bytes = 0, bytes_in_all = 0;  ///< of the main file; loops and calls stand still in it
};

struct PreviewOptions {
    PreviewCoordinates coordinates = PreviewCoordinates::MACHINE;
    std::size_t batch = 1024;  ///< most events per call of the listener
    /// After these a loop, or a call of the main program, counts as endless, which is an error; 0: never. See
    /// Settings. Statements; statements in a row without any motion, dwell or stop; machine time (motion at
    /// the programmed feed, rapids at least at the machine's speed).
    std::uint64_t statement_budget = 50000000;
    std::uint64_t idle_budget = 20000000;
    double time_budget_s = 100 * 3600.0;
    int max_errors = 20;                     ///< interpretation goes on behind a failed block until then
    std::uint64_t blocks_per_report = 4096;  ///< between two calls of `progress`
};

enum class PreviewEnd { DONE, FAILED, CANCELLED };

/// Interprets one program. Memory is bounded by a batch and the interpreter's own (gcode/README.md); the
/// listener may take as long as it likes. One thread.
class Preview {
  public:
    struct Listener {
        std::function<void(std::span<const PreviewEvent>)> events;
        std::function<bool(const PreviewProgress &)> progress;  ///< false cancels; may be empty
        /// From here on the program's way may depend on what only the running machine knows: the result of a
        /// probe or of an input. Told after all events before it; may be empty.
        std::function<void(const SourcePlace &, std::string_view what)> unknown{};
    };

    /// LinuxCNCs must outlive it.
    Preview(PreviewMachine machine, gcode::ToolSource &tools, gcode::ParameterSource &parameters,
            PreviewOptions options, Listener listener);
    ~Preview();

    /// Runs a file to its end. Errors go to `sink` with their places, also when the preview goes on after
    /// them. Any thread, but one at a time.
    PreviewEnd run(const std::string &path, diagnostics::Sink &sink);
    /// The same for a text; `name` stands for its file.
    PreviewEnd run_text(const std::string &name, std::string text, diagnostics::Sink &sink);

    const PreviewProgress &progress() const;
    const std::string &file(std::uint32_t index) const;
    /// The innermost subroutine, or in the main program what the last comment (section, NAME) said; empty at
    /// the beginning. Under cutter compensation the last move of a section may count for the next.
    const std::string &section(std::uint32_t index) const;
    std::string line_text(std::uint32_t file, int line) const;
    /// Of the line that is being read.
    SourcePlace place() const;
    /// Hands on the events up to now.
    void flush();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::gcode
