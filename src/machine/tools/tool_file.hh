// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table file of a machine: the one owner of the tool data (requirement G4).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/tools/tool_data.hh"

namespace mw::machine {

/// Not realtime; one thread. Each change is written to the file at once, atomically: by `keeper`, which
/// outlives this, or within the call where there is none.
class ToolFile final : public ToolData {
  public:
    /// An empty path is an empty table that lives in memory only; a file that is not there an empty one.
    /// `sink` is warned of that and of lines that cannot be used.
    static Result<std::unique_ptr<task::ToolStore>> load(const std::string &path, diagnostics::Sink &sink,
                                                         tools::Changer changer, journal::Writer *keeper);

    Result<> load_spindle(int index) override;
    Result<> set_entry(int index, const gcode::ToolEntry &entry) override;
    Result<> add(const gcode::ToolEntry &entry) override;
    Result<> remove(int index) override;
    Result<> save() override;
    bool isSettled() const override { return keeper_ == nullptr || keeper_->isSettled(path_); }
    Result<> reload() override;
    std::optional<Result<>> reload_result() override { return read_; }
    void drop_reload() override;
    void step() override;
    std::optional<std::string> take_warning() override;

  private:
    struct Reading;

    ToolFile(std::string path, tools::Changer changer, journal::Writer *keeper)
        : ToolData(tools::Table(changer)), path_(std::move(path)), keeper_(path_.empty() ? nullptr : keeper) {
    }
    tools::Changer changer() const { return isRandom() ? tools::Changer::RANDOM : tools::Changer::FIXED; }
    Result<> read(diagnostics::Sink &sink);
    void ask_for_text();
    void keep_warnings(const diagnostics::Sink &sink);
    /// After a change of the table.
    Result<> keep();
    /// Of a change that is undone where it cannot be saved.
    Result<> save_or_restore(tools::Table before);

    std::string path_;
    journal::Writer *keeper_;
    std::shared_ptr<Reading> reading_;          ///< under way
    bool is_reading_old_ = false;               ///< the table has changed since it began
    std::optional<Result<>> read_{Result<>{}};  ///< how the last one has ended
    std::vector<std::string> warnings_;         ///< of the last reading, not told yet
};

}  // namespace mw::machine
