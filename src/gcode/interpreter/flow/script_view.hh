// SPDX-License-Identifier: GPL-2.0-or-later
// The scripts' view of the interpreter: state, parameters, blocks and call levels.
#pragma once

#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/interpreter/codes/synchronisation.hh"
#include "gcode/interpreter/codes/tools/tools.hh"
#include "gcode/interpreter/flow/flow_parts.hh"
#include "gcode/interpreter/scripts/script_host.hh"

namespace mw::gcode::detail {

class ScriptView final : public InterpreterView {
  public:
    /// Runs a block and its calls, as InterpreterView::execute().
    using Execute = std::function<std::expected<bool, ScriptFault>(std::string_view text, int line)>;
    /// `parts` must outlive the view.
    ScriptView(const FlowParts &parts, Execute execute)
        : parts_(parts), executor_(parts.executor), execute_(std::move(execute)) {}

    std::expected<bool, ScriptFault> execute(std::string_view text, int line) override;
    Canon &canon() override;
    void deliver() override;
    void expect_input() override { executor_.awaited.is_input = true; }
    void expect_probe() override { executor_.awaited.isProbe = true; }

    double parameter(int number) const override;
    Result<> set_parameter(int number, double value) override;
    std::optional<double> named(std::string_view name) override;
    Result<> set_named(std::string_view name, double value) override;
    std::vector<std::string> local_names() const override;
    std::vector<std::string> global_names() const override;
    std::vector<std::string> predefined_names() const override;
    std::vector<std::string> script_names() const override;

    std::optional<ScriptValue> attribute(std::string_view name) const override;
    Result<> set_attribute(std::string_view name, const ScriptValue &value) override;
    std::vector<std::string_view> attribute_names() const override;

    ActiveCodes active_codes() const override { return executor_.active_codes(); }
    double spindle_speed(int spindle) const override;
    void set_spindle_speed(int spindle, double speed) override;
    Pose tool_offset() const override { return executor_.modes.frame.tool; }
    void set_tool_offset(const Pose &offset) override { move_by_tool_offset(executor_.modes, offset); }
    int count_tools() const override { return executor_.tools.count(); }
    ToolEntry tool(int index) const override;
    int find_tool(int number) const override { return executor_.tools.index_of_tool(number); }
    void load_tool() override { load_tool_at_index(executor_.tools, executor_.modes.tool); }
    void synch() override { synchronise(executor_.modes, executor_.parts); }

    ScriptBlock block(int level) const override;
    std::vector<ScriptContext> contexts() const override;
    const World &world() const override { return executor_.world(); }

  private:
    ScriptBlock remap_block(const ScriptCall &call, int level) const;

    const FlowParts &parts_;
    Executor &executor_;
    Execute execute_;
};

}  // namespace mw::gcode::detail
