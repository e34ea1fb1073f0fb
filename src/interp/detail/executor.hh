// SPDX-License-Identifier: GPL-2.0-or-later
// Executes parsed blocks: modes, order of execution, and what each code does to state and canon.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "interp/detail/block_values.hh"
#include "interp/detail/canon_queue.hh"
#include "interp/detail/evaluator.hh"
#include "interp/detail/frame.hh"
#include "interp/detail/program.hh"
#include "interp/detail/state.hh"
#include "interp/interpreter.hh"

namespace mw::interp::detail {

enum class Outcome { OK, SYNC, PROGRAM_END };

class Executor : public BuiltIns {
  public:
    Executor(World &world, ToolSource &tools, ParameterSource &source, const Settings &settings,
             Names &names);

    /// Words, settings and comments of a block; then its codes. False after setting the fault.
    bool run(const BlockView &view, std::string_view line_text);

    // What the parts share. The state is copied before a block and put back when it fails.
    State state;
    Parameters parameters;
    CanonQueue canon;
    Fault fault;
    Outcome outcome = Outcome::OK;

    Evaluator &evaluator() { return evaluator_; }
    World &world() { return world_; }
    const Settings &settings() const { return settings_; }

    /// Announces the state to the canon, as at the start of a program.
    void announce();
    /// Takes positions, tools and switches from the machine.
    void synch();
    /// Line and depth for #<_line> and #<_call_level>.
    void set_place(int line, int call_level, int remap_level);
    void set_returned(double value, bool isReturned);
    ActiveCodes active_codes() const;

    bool isBuiltInName(std::string_view name) const override;
    std::optional<double> built_in(std::string_view name) const override;
    double built_in(int number) const override;

    // Handlers, one per row of the table of codes.
    bool do_feed_word(const Code &code, const BlockValues &values);
    bool do_speed_word(const Code &code, const BlockValues &values);
    bool do_tool_word(const Code &code, const BlockValues &values);
    bool do_units(const Code &code, const BlockValues &values);
    bool do_straight(const Code &code, const BlockValues &values);
    bool do_end(const Code &code, const BlockValues &values);

  private:
    bool evaluate(const BlockView &view, BlockValues &values);
    bool add_code(char letter, double number, std::uint32_t column, BlockValues &values);
    bool insert_code(const Code &code, std::uint32_t column, BlockValues &values);
    bool choose_motion(BlockValues &values);
    bool check_words(const BlockValues &values);
    bool apply_settings(const BlockView &view);
    void run_comments(const BlockView &view, std::string_view line_text);

    Frame frame() const { return {state.g5x, state.g92, state.tool_offset, state.rotation_deg}; }
    /// Lengths of the parameter file and the tool table [machine units] to program units and back.
    double machine_to_program() const;
    Pose target(const BlockValues &values) const;
    std::string code_name(const Code &code) const;

    World &world_;
    ToolSource &tools_;
    ParameterSource &source_;
    const Settings &settings_;
    Names &names_;
    Evaluator evaluator_;
    int line_ = 0, call_level_ = 0, remap_level_ = 0;
    double returned_ = 0;
    bool isReturned_ = false;
};

}  // namespace mw::interp::detail
