// SPDX-License-Identifier: GPL-2.0-or-later
// NML configuration files: any accepted file can be used.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "clients/nml/config/config_file.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char *>(data), size);
    mw::diagnostics::Sink sink;
    const mw::nml::Config config = mw::nml::parse_config(text, "fuzz.nml", sink);
    for (const mw::nml::BufferSettings &buffer : config.buffers) {
        if (config.find_buffer(buffer.name) != &buffer || buffer.size == 0 || buffer.max_processes < 1) {
            std::abort();
        }
    }
    for (const mw::nml::ProcessSettings &process : config.processes) {
        if (!process.mayRead && !process.mayWrite) {
            std::abort();
        }
    }
    for (const mw::diagnostics::Diagnostic &told : sink.all()) {
        if (told.what.place.line < 1 || told.what.place.column < 1) {
            std::abort();
        }
    }
    return 0;
}
