// SPDX-License-Identifier: GPL-2.0-or-later
// What scripts see of the interpreter: its state, parameters, blocks and levels of call.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "interp/flow/flow.hh"
#include "interp/scripts/script_host.hh"

namespace mw::interp::detail {

class ScriptView final : public InterpreterView {
  public:
    explicit ScriptView(Flow &flow) : flow_(flow), executor_(flow.executor_) {}

    std::expected<bool, ScriptFault> execute(std::string_view text, int line) override;
    Canon &canon() override;
    void deliver() override;
    void expect_input() override { executor_.awaited.isInput = true; }
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
    Pose tool_offset() const override { return executor_.state.tool_offset; }
    void set_tool_offset(const Pose &offset) override { executor_.set_tool_offset(offset); }
    int count_tools() const override { return executor_.tools().count(); }
    ToolEntry tool(int index) const override;
    int find_tool(int number) const override { return executor_.tools().index_of_tool(number); }
    void load_tool() override { executor_.load_indexed_tool(); }
    void synch() override { executor_.synch(); }

    ScriptBlock block(int level) const override;
    std::vector<ScriptContext> contexts() const override;
    const World &world() const override { return executor_.world(); }

  private:
    ScriptBlock remap_block(const Flow::Call &call, int level) const;
    std::string line_text() const;

    Flow &flow_;
    Executor &executor_;
};

}  // namespace mw::interp::detail
