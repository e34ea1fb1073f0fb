// SPDX-License-Identifier: GPL-2.0-or-later
// What is read from a tool table must be written so that it reads the same again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tool/table.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    using mw::tool::Table;
    const auto table = Table::parse({reinterpret_cast<const char *>(data), size}, "fuzz.tbl");
    if (!table) {
        return 0;
    }
    Table changed = *table;
    for (int i = 1; i < changed.count(); ++i) {
        changed.set_entry(i, table->entry(i));
    }
    const auto again = Table::parse(changed.text(), "again.tbl");
    if (!again || again->count() != table->count()) {
        std::abort();
    }
    for (int i = 1; i < table->count(); ++i) {
        const mw::tool::ToolEntry &a = table->entry(i), &b = again->entry(i);
        if (a.toolno != b.toolno || a.pocketno != b.pocketno || a.offset != b.offset ||
            a.diameter != b.diameter) {
            std::abort();
        }
    }
    return 0;
}
