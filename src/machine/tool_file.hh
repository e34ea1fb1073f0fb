// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table file of a machine: the one owner of the tool data (requirement G4).
#pragma once

#include <memory>
#include <string>

#include "task/link/tool_store.hh"
#include "tool/table.hh"

namespace mw::machine {

/// Not realtime; one thread. Each change is written to the file at once, atomically.
class ToolFile final : public task::ToolStore {
  public:
    /// An empty path is an empty table that lives in memory only; a file that is not there an empty one that
    /// its first change makes. `sink` is warned of that and of lines that cannot be used.
    static Result<std::unique_ptr<ToolFile>> load(const std::string &path, diag::Sink *sink = nullptr);

    int count() const override { return table_.count(); }
    interp::ToolEntry entry(int index) const override { return table_.entry(index); }
    int index_of_tool(int toolno) const override { return table_.index_of_tool(toolno); }
    bool isRandom() const override { return false; }

    Result<> load_spindle(int index) override;
    Result<> set_entry(int index, const interp::ToolEntry &entry) override;
    Result<> reload() override;
    std::uint64_t version() const override { return version_; }

  private:
    Result<> reload(diag::Sink &sink);
    explicit ToolFile(std::string path) : path_(std::move(path)) {}

    std::string path_;
    tool::Table table_;
    std::uint64_t version_ = 1;
};

}  // namespace mw::machine
