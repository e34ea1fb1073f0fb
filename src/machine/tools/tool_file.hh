// SPDX-License-Identifier: GPL-2.0-or-later
// The tool table file of a machine: the only owner of the tool data (requirement G4).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "machine/tools/tool_data.hh"

namespace mw::machine {

/// Not realtime; one thread. Each change is written to the file at once, atomically: by `keeper`, which must
/// outlive this object, or within the call if there is no keeper.
class ToolFile final : public ToolData {
  public:
    /// An empty path is an empty table in memory; a missing file is an empty table. `sink` receives warnings
    /// about a missing file and about lines that cannot be used.
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
    /// Writes the table after a change.
    Result<> keep();
    /// Saves a change, and undoes it if it cannot be saved.
    Result<> save_or_restore(tools::Table before);

    std::string path_;
    journal::Writer *keeper_;
    std::shared_ptr<Reading> reading_;          ///< the reading under way
    bool is_reading_old_ = false;               ///< the table has changed since the reading began
    std::optional<Result<>> read_{Result<>{}};  ///< result of the last reading
    std::vector<std::string> warnings_;         ///< warnings of the last reading, not reported yet
};

}  // namespace mw::machine
