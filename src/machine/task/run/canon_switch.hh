// SPDX-License-Identifier: GPL-2.0-or-later
// The canon of the interpreter: the machine, or temporarily a calculation.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "gcode/canon/machine_canon.hh"
#include "gcode/interpreter/world.hh"
#include "machine/task/run/search_machine.hh"

namespace mw::task {

/// All calls come from one thread.
class CanonSwitch final : public gcode::MachineCanon,
                          public gcode::World,
                          public gcode::ToolSource,
                          public gcode::ParameterSource {
  public:
    struct Real {
        gcode::MachineCanon &canon;
        gcode::World &world;
        gcode::ToolSource &tools;
        gcode::ParameterSource &parameters;
        /// Called when the search has reached its target: later calls go to `canon`.
        std::function<void(const SearchMachine &)> begin_passing;
    };
    explicit CanonSwitch(Real real) : real_(std::move(real)) {}

    /// Sends all calls to `search`; null: to the machine again. From block `first` of the program (from 1; 0:
    /// none) calls also reach the machine's canon.
    void set_search(SearchMachine *search, std::uint32_t first = 0) {
        search_ = search;
        first_ = first;
        passing_ = false;
    }
    /// True after that block has been reached.
    bool isPassing() const { return passing_; }
    /// Name of a value that the program has read from the running machine and that a search cannot
    /// calculate; empty: none since the last forget_doubt().
    const std::string &doubt() const { return doubt_; }
    void forget_doubt() { doubt_.clear(); }

    void begin_block(const gcode::BlockRef &block) override {
        if (!passing_ && search_ != nullptr && first_ > 0 && search_->blocks() + 1 >= first_) {
            passing_ = true;
            real_.begin_passing(*search_);
        }
        (isSearching() ? static_cast<gcode::MachineCanon &>(*search_) : real_.canon).begin_block(block);
    }
    void take(const gcode::MachineCall &call) override {
        if (!isSearching()) {
            note_doubt(call);
        }
        (isSearching() ? static_cast<gcode::MachineCanon &>(*search_) : real_.canon).take(call);
    }

    gcode::MachineSnapshot snapshot() const override { return world().snapshot(); }
    gcode::LengthUnits machine_units() const override { return world().machine_units(); }
    double mm_per_machine_unit() const override { return world().mm_per_machine_unit(); }
    unsigned axis_mask() const override { return world().axis_mask(); }
    int count_spindles() const override { return world().count_spindles(); }
    bool isBlockDeleteOn() const override { return world().isBlockDeleteOn(); }
    bool isOptionalStopOn() const override { return world().isOptionalStopOn(); }
    bool isSynchedAtOnce() const override { return world().isSynchedAtOnce(); }

    int count() const override { return tools().count(); }
    gcode::ToolEntry entry(int index) const override { return tools().entry(index); }
    int index_of_tool(int toolno) const override { return tools().index_of_tool(toolno); }
    bool isRandom() const override { return tools().isRandom(); }

    std::optional<double> ini_value(std::string_view section, std::string_view key) const override {
        return parameters().ini_value(section, key);
    }
    std::optional<double> hal_value(std::string_view name) const override {
        doubt_ = search_ == nullptr ? "the HAL value " + std::string(name) : doubt_;
        return parameters().hal_value(name);
    }

  private:
    bool isSearching() const { return search_ != nullptr && !passing_; }
    void note_doubt(const gcode::MachineCall &call) {
        if (std::holds_alternative<gcode::ProbeMove>(call)) {
            doubt_ = "a probe";
        } else if (std::holds_alternative<gcode::WaitInput>(call)) {
            doubt_ = "an input (M66)";
        } else if (std::holds_alternative<gcode::ReloadTools>(call)) {
            doubt_ = "the reloaded tool table (G10 L0)";
        } else if (std::holds_alternative<gcode::ChangeTool>(call) && isRandom()) {
            doubt_ = "the pockets of a random tool changer (M6)";
        } else if (std::holds_alternative<gcode::ChangeToolNumber>(call) && isRandom()) {
            doubt_ = "the pockets of a random tool changer (M61)";
        }
    }
    const gcode::World &world() const { return search_ != nullptr ? *search_ : real_.world; }
    const gcode::ToolSource &tools() const { return search_ != nullptr ? *search_ : real_.tools; }
    const gcode::ParameterSource &parameters() const {
        return search_ != nullptr ? *search_ : real_.parameters;
    }

    Real real_;
    SearchMachine *search_ = nullptr;
    std::uint32_t first_ = 0;
    bool passing_ = false;
    mutable std::string doubt_;
};

}  // namespace mw::task
