// SPDX-License-Identifier: GPL-2.0-or-later
// The moves of a program with their positions in the source, as a stream, without running it.
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
    DWELL,        ///< dwell of `value` [s]
    TOOL_CHANGE,  ///< from now on tool `number` is in the spindle
    STOP,         ///< M0, M1 and M60: motion stops
    PLANNER,      ///< G64 R: from now on the path is planned with jerk limits (`number` 1) or without (0)
};

/// A move, or an event between moves. Poses are in the selected coordinates.
struct PreviewEvent {
    PreviewKind kind = PreviewKind::RAPID;
    bool by_machine = false;        ///< a move that the machine makes itself for a tool change
    bool spindle_awaited = false;   ///< motion waits before this move until the spindle is at speed
    geometry::Pose start, end;      ///< equal if the event is not a move
    geometry::Pose centre, normal;  ///< of an arc, as in ArcMove
    geometry::Pose tool_offset;     ///< active during a move; start and end contain it unless they are TIP
    double angle_rad = 0;
    geometry::MoveSettings settings;  ///< of a move [machine units]
    /// Speed of the spindle that a move follows, at its middle, as programmed (with G96). [rev/min]
    double spindle_rpm = 0;
    double value = 0;
    int number = 0;
    int line = 0, sequence = 0, call_level = 0;  ///< line and call level as in BlockRef
    std::uint32_t file = 0;                      ///< see Preview::file
    std::uint32_t section = 0;                   ///< see Preview::section
};

enum class PreviewCoordinates {
    MACHINE,  ///< machine units; the controlled point of the machine
    TIP,      ///< as MACHINE without the tool offset: the tool tip
    PROGRAM,  ///< program units and coordinates, as programmed
};

/// The machine for which a program is interpreted.
struct PreviewMachine {
    gcode::Settings interpreter;
    gcode::LengthUnits units = gcode::LengthUnits::MM;
    unsigned axis_mask = 0x1ff;
    int spindles = 1;
    bool block_delete_on = true;
    std::string parameter_file;  ///< only read; empty: none
    geometry::Pose position;     ///< start position [machine units]
    int tool_in_spindle = 0;
    /// The machine's own moves for a tool change, from a position; none when not set.
    std::function<std::vector<geometry::Pose>(const geometry::Pose &)> tool_change_moves;
};

struct PreviewProgress {
    std::uint64_t blocks = 0, events = 0;
    std::uint64_t bytes = 0,
                  bytes_in_all = 0;  ///< position in the main file; constant during loops and calls
};

struct PreviewOptions {
    PreviewCoordinates coordinates = PreviewCoordinates::MACHINE;
    std::size_t batch = 1024;  ///< maximum number of events per call of the listener
    /// Limits after which a loop, or a call of the main program, counts as endless, which is an error; 0: no
    /// limit. See Settings. Statements; consecutive statements without motion, dwell or stop; machine time
    /// (motion at the programmed feed, rapids at the machine's speed or slower).
    std::uint64_t statement_budget = 50000000;
    std::uint64_t idle_budget = 20000000;
    double time_budget_s = 100 * 3600.0;
    int max_errors = 20;  ///< interpretation continues after failed blocks up to this number
    std::uint64_t blocks_per_report = 4096;  ///< between two calls of `progress`
};

enum class PreviewEnd { DONE, FAILED, CANCELLED };

/// Interprets one program. Memory is limited to one batch and the interpreter (gcode/README.md). The listener
/// may be slow. All calls come from one thread.
class Preview {
  public:
    struct Listener {
        std::function<void(std::span<const PreviewEvent>)> events;
        std::function<bool(const PreviewProgress &)> progress;  ///< returns false to cancel; may be empty
        /// From now on the program may depend on values known only to the running machine: the result of a
        /// probe or an input. Called after all events before it; may be empty.
        std::function<void(const SourcePlace &, std::string_view what)> unknown{};
    };

    /// The arguments must outlive the preview.
    Preview(PreviewMachine machine, gcode::ToolSource &tools, gcode::ParameterSource &parameters,
            PreviewOptions options, Listener listener);
    ~Preview();

    /// Runs a file to its end. Reports errors with their positions to `sink` and continues where possible.
    /// Any thread, one at a time.
    PreviewEnd run(const std::string &path, diagnostics::Sink &sink);
    /// Runs a text; `name` replaces the file name.
    PreviewEnd run_text(const std::string &name, std::string text, diagnostics::Sink &sink);

    const PreviewProgress &progress() const;
    const std::string &file(std::uint32_t index) const;
    /// The innermost subroutine, or in the main program the text of the last comment (section, NAME); empty
    /// at the beginning. Under cutter compensation the last move of a section may be counted in the next
    /// section.
    const std::string &section(std::uint32_t index) const;
    std::string line_text(std::uint32_t file, int line) const;
    /// Position of the line that is being read.
    SourcePlace place() const;
    /// Passes the collected events to the listener.
    void flush();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mw::gcode
