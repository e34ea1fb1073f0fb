// SPDX-License-Identifier: GPL-2.0-or-later
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "base/ini/ini_reader.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char *>(data), size);
    if (text.find("#INCLUDE") != std::string_view::npos) {
        return 0;  // other files are not part of the input
    }
    mw::diagnostics::Sink sink;
    const auto file = mw::ini::IniFile::parse(text, "fuzz.ini", sink);
    mw::ini::IniReader reader(file, sink);
    for (const auto &entry : file.entries()) {
        reader.real(entry.section, entry.key, 0.0, {-1.0, 1e6});
        reader.integer(entry.section, entry.key, 0, -5, 500);
        reader.boolean(entry.section, entry.key, false);
    }
    reader.report_unknown(true);
    return 0;
}
