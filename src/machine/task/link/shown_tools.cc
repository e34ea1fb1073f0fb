// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/link/shown_tools.hh"

namespace mw::task {

std::optional<messages::ToolTable> ShownTools::step(const ToolStore &tools) {
    const std::uint64_t version = tools.version();
    if (version == version_) {
        return std::nullopt;
    }
    version_ = version;
    messages::ToolTable table{version, {}};
    for (int i = 0; i < tools.count(); ++i) {
        const gcode::ToolEntry entry = tools.entry(i);
        table.tools.push_back({entry.toolno, entry.pocketno, entry.offset, entry.diameter, entry.frontangle,
                               entry.backangle, entry.orientation, entry.comment});
    }
    return table;
}

}  // namespace mw::task
