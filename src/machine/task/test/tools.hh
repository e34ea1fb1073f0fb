// SPDX-License-Identifier: GPL-2.0-or-later
// A tool table in memory.
#pragma once

#include "machine/task/link/tool_store.hh"

namespace mw::task::test {

/// Tool 5 in pocket 3; entry 0 is the spindle.
class OneTool final : public ToolStore {
  public:
    int count() const override { return 2; }
    gcode::ToolEntry entry(int index) const override {
        gcode::ToolEntry entry;
        entry.toolno = index == 0 ? in_spindle : 5;
        entry.pocketno = index == 0 ? 0 : 3;
        return entry;
    }
    int index_of_tool(int toolno) const override { return toolno == 5 ? 1 : -1; }
    bool isRandom() const override { return false; }
    Result<> load_spindle(int index) override {
        in_spindle = index == 1 ? 5 : 0;
        return {};
    }
    Result<> set_entry(int, const gcode::ToolEntry &) override { return {}; }
    Result<> add(const gcode::ToolEntry &) override { return fail("full"); }
    Result<> remove(int) override { return fail("fixed"); }
    bool isSettled() const override { return is_written; }
    Result<> reload() override { return {}; }
    std::optional<Result<>> reload_result() override {
        return is_read ? std::optional(Result<>{}) : std::nullopt;
    }
    void drop_reload() override { ++reloads_dropped; }
    std::uint64_t version() const override { return version_now; }

    bool is_written = true, is_read = true;  ///< the disk answers
    int reloads_dropped = 0;
    int in_spindle = 0;
    std::uint64_t version_now = 1;
};

}  // namespace mw::task::test
