// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/tool_data.hh"

#include <algorithm>

#include "machine/tool_database.hh"
#include "machine/tool_file.hh"

namespace mw::machine {

Result<> ToolData::load_spindle(int index) {
    if (index < 0 || index >= count()) {
        return fail("the tool table has no entry " + std::to_string(index));
    }
    table_.load_spindle(index);
    ++version_;
    return {};
}

Result<> ToolData::set_entry(int index, const interp::ToolEntry &entry) {
    const bool isCopy = index == 0 && !isRandom();
    const bool isThere = index >= 0 && index < count();
    const bool isSame = isThere && (isCopy || table_.entry(index).toolno == entry.toolno);
    const int found = isSame ? index : table_.index_of_tool(entry.toolno);
    if (found < 0) {
        return fail("the tool table has no tool " + std::to_string(entry.toolno));
    }
    table_.set_entry(found, entry);
    ++version_;
    return {};
}

void ToolData::replace(tool::Table table) {
    const int in_spindle = table_.entry(0).toolno;
    table_ = std::move(table);
    if (!isRandom() && in_spindle > 0) {
        table_.load_spindle(std::max(0, table_.index_of_tool(in_spindle)));
    }
    ++version_;
}

Result<std::unique_ptr<task::ToolStore>> open_tools(const MachineConfig &machine, diag::Sink &sink,
                                                    const ToolOptions &options) {
    const auto changer = machine.isRandomToolchanger ? tool::Changer::RANDOM : tool::Changer::FIXED;
    if (!machine.tool_database.empty()) {
        return ToolDatabase::start({machine.tool_database, machine.ini_folder, changer, options.isWaitedFor},
                                   sink);
    }
    return ToolFile::load(machine.tool_table_file, sink, changer);
}

Result<std::unique_ptr<task::ToolStore>> read_tools(const MachineConfig &machine, diag::Sink &sink) {
    const auto opened = open_tools(machine, sink);
    if (!opened.has_value()) {
        return std::unexpected(opened.error());
    }
    return std::make_unique<ToolData>(static_cast<const ToolData &>(**opened));
}

}  // namespace mw::machine
