// SPDX-License-Identifier: GPL-2.0-or-later
// A tool table and tool life that were read must be written so that they are read unchanged, for both types
// of tool changer.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gcode/tools/life.hh"
#include "gcode/tools/table.hh"

namespace {

using mw::tools::Changer;
using mw::tools::Table;

void check_written(const Table &table, Changer changer) {
    Table changed = table;
    const int first = table.isRandom() ? 0 : 1;
    for (int i = first; i < changed.count(); ++i) {
        changed.set_entry(i, table.entry(i));
    }
    const auto again = Table::parse(changed.text(), "again.tbl", changer);
    if (!again || again->count() != table.count()) {
        std::abort();
    }
    for (int i = first; i < table.count(); ++i) {
        const mw::tools::ToolEntry &a = table.entry(i), &b = again->entry(i);
        if (a.toolno != b.toolno || a.pocketno != b.pocketno || a.offset != b.offset ||
            a.diameter != b.diameter) {
            std::abort();
        }
    }
}

/// Changes lose no entry, also in files with invalid lines.
void check_swaps(std::string_view text) {
    mw::diagnostics::Sink sink;
    Table table = Table::parse_leniently(text, "fuzz.tbl", sink, Changer::RANDOM);
    int tools = 0;
    for (int i = 0; i < table.count(); ++i) {
        tools += table.entry(i).toolno >= 0 ? 1 : 0;
        table.load_spindle(i);
    }
    for (int i = 0; i < table.count(); ++i) {
        tools -= table.entry(i).toolno >= 0 ? 1 : 0;
        if (table.entry(i).toolno >= 0 && table.entry(i).pocketno != i) {
            std::abort();
        }
    }
    if (tools != 0) {
        std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char *>(data), size);
    for (const Changer changer : {Changer::FIXED, Changer::RANDOM}) {
        const auto table = Table::parse(text, "fuzz.tbl", changer);
        if (table) {
            check_written(*table, changer);
        }
    }
    check_swaps(text);
    const auto book = mw::tools::LifeBook::parse(text, "fuzz.life");
    if (book && !mw::tools::LifeBook::parse(book->text(), "again.life")) {
        std::abort();
    }
    return 0;
}
