// SPDX-License-Identifier: GPL-2.0-or-later
// Runs parsed blocks: owns the objects that codes use and passes them to the codes. Independent of individual
// codes.
#pragma once

#include <optional>
#include <set>
#include <string>

#include "gcode/canon/canon_queue.hh"
#include "gcode/interpreter/codes/around_block.hh"
#include "gcode/interpreter/codes/attributes.hh"
#include "gcode/interpreter/codes/block_reader.hh"
#include "gcode/interpreter/codes/code_parts.hh"
#include "gcode/interpreter/codes/kept_parameters.hh"
#include "gcode/interpreter/codes/lathe/lathe_cycles.hh"
#include "gcode/interpreter/codes/remaps.hh"
#include "gcode/interpreter/codes/tools/tool_table.hh"
#include "gcode/interpreter/expressions/evaluator.hh"
#include "gcode/interpreter/interpreter_state.hh"
#include "gcode/syntax/program.hh"

namespace mw::gcode::detail {

/// Supplies named parameters that scripts define.
class ScriptNames {
  public:
    virtual ~ScriptNames() = default;
    virtual bool hasName(std::string_view name) const = 0;
    /// Nothing after setting the fault.
    virtual std::optional<double> value_of(std::string_view name) = 0;
};

/// Data of the current block.
struct RunningBlock {
    explicit RunningBlock(Fault &errors) : values(errors) {}

    BlockValues values;
    std::string comment;      ///< kept only if there are remaps
    std::string script_text;  ///< the statements of its ;py, line
    int number = -1;          ///< its N word
};

class Executor : public InterpreterState, public BuiltIns {
  public:
    Executor(World &world, ToolSource &tool_source, ParameterSource &source, const Settings &settings,
             Names &names);

    /// Runs words, settings and comments of a block; then its codes. False after setting the fault.
    /// `line_text` is read if the block has comments.
    bool run(const BlockView &view, std::string_view line_text);
    /// Runs the rest of a block that a remapped code has interrupted.
    bool resume(const PendingBlock &pending);

    // The objects other than the state. Each can undo the changes of a failed block; the state is restored
    // from a copy.
    ToolTable tools;
    CanonQueue canon;
    Remaps remaps;
    LatheCycles lathe;
    // Results of a block for the caller.
    Fault fault;
    Outcome outcome = Outcome::OK;
    FanucCall fanuc_call;  ///< the call by M98, with Outcome::CALL_FANUC
    Awaited awaited;
    BlockPlace block_place;
    ScriptLevels script_levels;
    std::vector<NurbsPoint> control_points;  ///< control points of the open NURBS
    /// The parts as codes use them.
    CodeParts parts;

    Evaluator &evaluator() { return evaluator_; }
    const World &world() const { return parts.world; }
    /// Statements of the ;py, line of the outcome.
    const std::string &script_text() const { return block_.script_text; }

    /// Saves state and queue, so that rollback() can undo the block; commit() keeps its changes.
    void begin_block();
    /// As begin_block(), for a block that may change no state. Code that changes the state calls keep_state()
    /// first.
    void begin_light_block();
    void keep_state();
    void commit();
    void rollback();
    /// Passes on the queued calls that no later block can change.
    void flush(Canon &target);
    /// After an abort: removes all queued calls and pending results.
    void abort_block();

    /// Begins the local names and modes of a subroutine. pop_call() returns to those of the caller and
    /// restores the modes saved by M73.
    void push_call();
    bool pop_call(bool is_fanuc);
    /// Ends calls until `depth` of them remain, without restoring the modes saved by M73.
    void drop_calls(std::size_t depth = 0);

    ActiveCodes active_codes() const { return InterpreterState::active_codes(block_place.sequence); }
    /// Restores a state; entries of the tool table and awaited results are dropped.
    void restore(const InterpreterState &kept);

    // Values that programs and scripts read.
    AttributeSources attribute_sources();
    void set_script_names(ScriptNames *names) { script_names_ = names; }
    /// INI values that the program has read, as names of parameters.
    const std::set<std::string, std::less<>> &ini_names_read() const { return ini_names_read_; }
    bool isBuiltInName(std::string_view name) const override;
    std::optional<double> built_in(std::string_view name) const override;
    double built_in(int number) const override;

  private:
    bool run_last_comment(const BlockView &view, std::string_view line_text);
    bool run_codes(const BlockValues &values, std::size_t first);
    KeptSources kept_sources() const;

    ParameterSource &source_;
    Names &names_;
    Evaluator evaluator_;
    RunningBlock block_;
    BlockSettings settings_;
    AxisCheck axis_check_;
    BlockCodes codes_before_;
    State before_;  ///< modes before the block, saved by keep_state()
    bool state_kept_ = false;
    ScriptNames *script_names_ = nullptr;
    mutable std::set<std::string, std::less<>> ini_names_read_;
};

}  // namespace mw::gcode::detail
