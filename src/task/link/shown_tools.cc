// SPDX-License-Identifier: GPL-2.0-or-later
#include "task/link/shown_tools.hh"

namespace mw::task {

std::optional<msgs::ToolTable> ShownTools::step(const ToolStore &tools) {
    const std::uint64_t version = tools.version();
    if (version == version_) {
        return std::nullopt;
    }
    version_ = version;
    msgs::ToolTable table{version, {}};
    for (int i = 0; i < tools.count(); ++i) {
        const interp::ToolEntry entry = tools.entry(i);
        table.tools.push_back({entry.toolno, entry.pocketno, entry.offset, entry.diameter, entry.frontangle,
                               entry.backangle, entry.orientation, entry.comment});
    }
    return table;
}

}  // namespace mw::task
