// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table file of a machine: the one owner of the tool data (requirement G4).
#pragma once

#include <string>

#include "machine/tool_data.hh"

namespace mw::machine {

/// Not realtime; one thread. Each change is written to the file at once, atomically.
class ToolFile final : public ToolData {
  public:
    /// An empty path is an empty table that lives in memory only; a file that is not there an empty one.
    /// `sink` is warned of that and of lines that cannot be used.
    static Result<std::unique_ptr<task::ToolStore>> load(const std::string &path, diag::Sink &sink,
                                                         tool::Changer changer = tool::Changer::FIXED);

    Result<> load_spindle(int index) override;
    Result<> set_entry(int index, const interp::ToolEntry &entry) override;
    Result<> add(const interp::ToolEntry &entry) override;
    Result<> remove(int index) override;
    Result<> reload() override;
    std::optional<std::string> take_warning() override;

  private:
    ToolFile(std::string path, tool::Changer changer)
        : ToolData(tool::Table(changer)), path_(std::move(path)) {}
    Result<> read(diag::Sink &sink);
    Result<> save() const { return path_.empty() ? Result<>{} : table().save(path_); }

    std::string path_;
    std::vector<std::string> warnings_;  ///< of the last reading, not told yet
};

}  // namespace mw::machine
