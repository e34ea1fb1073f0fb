// SPDX-License-Identifier: GPL-2.0-or-later
// Answers of a database program, [EMCIO]DB_PROGRAM: any bytes, to all requests. The first byte selects the
// changer and the request.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "machine/tools/tool_database.hh"

namespace {

using namespace mw;

/// A folder of this process.
const std::filesystem::path &folder() {
    static const std::filesystem::path made = [] {
        auto path =
            std::filesystem::temp_directory_path() / ("mw_fuzz_answers_" + std::to_string(::getpid()));
        std::filesystem::create_directories(path);
        return path;
    }();
    return made;
}

/// Tools with one number are one tool; a changer that swaps has each tool in its own pocket.
void check(const task::ToolStore &tools) {
    std::set<int> numbers;
    if (tools.count() < 1) {
        std::abort();
    }
    for (int i = tools.isRandom() ? 0 : 1; i < tools.count(); ++i) {
        const gcode::ToolEntry entry = tools.entry(i);
        const bool isTool = tools.isRandom() ? entry.toolno >= 0 : entry.toolno > 0;
        const bool isMisplaced = isTool && tools.isRandom() && entry.pocketno != i;
        if (isMisplaced || (isTool && !numbers.insert(entry.toolno).second)) {
            std::abort();
        }
    }
}

void ask(task::ToolStore &tools, unsigned choice) {
    const int index = static_cast<int>(choice % 7) % tools.count();
    switch (choice % 3) {
    case 0: static_cast<void>(tools.load_spindle(index)); break;
    case 1: {
        gcode::ToolEntry entry = tools.entry(index);
        entry.diameter += 1;
        static_cast<void>(tools.set_entry(index, entry));
        break;
    }
    default: static_cast<void>(tools.reload()); break;
    }
    tools.step();
    while (const auto warning = tools.take_warning()) {
        if (warning->empty()) {
            std::abort();
        }
    }
    check(tools);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    if (size < 1) {
        return 0;
    }
    const std::filesystem::path answers = folder() / "answers";
    std::ofstream(answers, std::ios::binary)
        .write(reinterpret_cast<const char *>(data) + 1, static_cast<std::streamsize>(size - 1));
    diagnostics::Sink sink;
    machine::ToolDatabase::Setup setup;
    setup.command = "/bin/cat " + answers.string();
    setup.folder = folder();
    setup.changer = data[0] % 2 == 0 ? tools::Changer::FIXED : tools::Changer::RANDOM;
    setup.awaited = true;
    const auto started = machine::ToolDatabase::start(setup, sink);
    if (!started.has_value()) {
        if (started.error().message.empty()) {
            std::abort();
        }
        return 0;
    }
    check(**started);
    for (unsigned choice = data[0] / 2U, i = 0; i < 4; ++i, choice = choice / 3 + i) {
        ask(**started, choice);
    }
    return 0;
}
