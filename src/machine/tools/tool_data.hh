// SPDX-License-Identifier: GPL-2.0-or-later
// The tools of a machine in memory, and where they are kept: a file or a database program.
#pragma once

#include <memory>

#include "base/diagnostics/sink.hh"
#include "gcode/tools/life.hh"
#include "gcode/tools/table.hh"
#include "machine/config/machine_config.hh"
#include "machine/journal/writer.hh"
#include "machine/task/link/tool_store.hh"

namespace mw::machine {

/// Changes stay in memory: for those who look ahead. Not realtime; one thread.
class ToolData : public task::ToolStore {
  public:
    explicit ToolData(tools::Table table) : table_(std::move(table)) {}
    ToolData(const ToolData &other) = delete;
    ToolData &operator=(const ToolData &other) = delete;
    ~ToolData() override { save_life(); }

    int count() const override { return table_.count(); }
    gcode::ToolEntry entry(int index) const override { return table_.entry(index); }
    int index_of_tool(int toolno) const override { return table_.index_of_tool(toolno); }
    bool isRandom() const override { return table_.isRandom(); }

    Result<> load_spindle(int index) override;
    Result<> set_entry(int index, const gcode::ToolEntry &entry) override;
    Result<> add(const gcode::ToolEntry &entry) override;
    Result<> remove(int index) override;
    Result<> reload() override { return {}; }
    std::uint64_t version() const override { return version_; }

    /// Keeps the life of tools in this file from here on; `sink` is warned when it cannot be read. It is
    /// written at changes of the tool, after each minute in cut, and by save_life(): by `keeper`, who
    /// outlives this.
    void keep_life(const std::string &path, journal::Writer &keeper, diagnostics::Sink &sink);
    void save_life();
    void note_cut(int toolno, const tools::CutLife &cut) override;
    tools::CutLife life(int toolno) const override { return life_.of(toolno); }

    const tools::Table &table() const { return table_; }

  protected:
    /// Takes the tools that were read; what the spindle of a fixed changer holds stays.
    void replace(tools::Table table);
    /// As it was before a change that could not be kept.
    void restore(tools::Table table) {
        table_ = std::move(table);
        ++version_;
    }
    void forget_life(int toolno);

  private:
    void write_life();

    tools::Table table_;
    std::uint64_t version_ = 1;
    tools::LifeBook life_;
    std::string life_path_;  ///< empty: nowhere
    journal::Writer *keeper_ = nullptr;
    double unsaved_life_s_ = 0;
};

/// How the tools of a machine are opened.
struct ToolOptions {
    journal::Writer *keeper = nullptr;  ///< writes files, of a machine that really cuts; outlives the tools
    /// A database program and the disk of the tool table are waited for within a cycle: for virtual clocks.
    bool isWaitedFor = false;
};

/// The owner of the machine's tools. `sink` is warned of lines that cannot be used.
Result<std::unique_ptr<task::ToolStore>> open_tools(const MachineConfig &machine, diagnostics::Sink &sink,
                                                    const ToolOptions &options = {});
/// The tools as they are now, for who looks ahead: nothing is written.
Result<std::unique_ptr<task::ToolStore>> read_tools(const MachineConfig &machine, diagnostics::Sink &sink);

}  // namespace mw::machine
