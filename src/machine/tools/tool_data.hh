// SPDX-License-Identifier: GPL-2.0-or-later
// The tools of a machine in memory, and their storage: a file or a database program.
#pragma once

#include <memory>

#include "base/diagnostics/sink.hh"
#include "gcode/tools/life.hh"
#include "gcode/tools/table.hh"
#include "machine/config/machine_config.hh"
#include "machine/journal/writer.hh"
#include "machine/task/link/tool_store.hh"

namespace mw::machine {

/// Keeps changes only in memory, for calculations ahead. Not realtime; one thread.
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

    /// From now on stores tool life in this file; `sink` receives a warning if it cannot be read. `keeper`,
    /// which must outlive this object, writes it at tool changes, after each minute of cutting, and in
    /// save_life().
    void keep_life(const std::string &path, journal::Writer &keeper, diagnostics::Sink &sink);
    void save_life();
    void note_cut(int toolno, const tools::CutLife &cut) override;
    tools::CutLife life(int toolno) const override { return life_.of(toolno); }

    const tools::Table &table() const { return table_; }

  protected:
    /// Replaces the tools by those that were read; a fixed changer keeps the tool in its spindle.
    void replace(tools::Table table);
    /// Restores the table before a change that could not be stored.
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
    std::string life_path_;  ///< empty: not stored
    journal::Writer *keeper_ = nullptr;
    double unsaved_life_s_ = 0;
};

/// Options for opening the tools of a machine.
struct ToolOptions {
    journal::Writer *keeper =
        nullptr;  ///< writes the files of a machine that actually cuts; must outlive the tools
    /// Waits within a cycle for a database program and the disk of the tool table; for virtual clocks.
    bool awaited = false;
};

/// The tools of the machine. `sink` receives warnings about lines that cannot be used.
Result<std::unique_ptr<task::ToolStore>> open_tools(const MachineConfig &machine, diagnostics::Sink &sink,
                                                    const ToolOptions &options = {});
/// A copy of the current tools for calculations ahead; it writes nothing.
Result<std::unique_ptr<task::ToolStore>> read_tools(const MachineConfig &machine, diagnostics::Sink &sink);

}  // namespace mw::machine
