// SPDX-License-Identifier: GPL-2.0-or-later
#include "app/ui_path.hh"

#include <algorithm>
#include <filesystem>

#include "machine/ini_parameters.hh"
#include "machine/program_check.hh"
#include "machine/tool_data.hh"
#include "machine/unscripted.hh"
#include "ui/web/elsewhere.hh"
#include "ui/web/path_chunks.hh"

namespace mw::app {
namespace {

constexpr double MM_PER_INCH = 25.4;

}  // namespace

using ui::web::step_back;

PathReaders::~PathReaders() {
    for (Reader &reader : readers_) {
        reader.pieces->cancel();
        reader.thread.join();
    }
}

Result<std::shared_ptr<ui::web::PieceQueue>> PathReaders::read(const std::string &path) {
    readers_.remove_if([](Reader &reader) {
        const bool isOver = reader.isOver.load(std::memory_order_acquire);
        if (isOver) {
            reader.thread.join();
        }
        return isOver;
    });
    if (readers_.size() >= MOST) {
        return fail("as many programs as can be are being read: ask again later");
    }
    Reader &reader = readers_.emplace_back();
    reader.pieces = std::make_shared<ui::web::PieceQueue>();
    reader.thread = std::thread([this, &reader, path] {
        step_back();
        read_all(reader, path);
        reader.pieces->end();
        // Release: whoever sees it may join without waiting.
        reader.isOver.store(true, std::memory_order_release);
    });
    return reader.pieces;
}

void PathReaders::read_all(Reader &reader, const std::string &path) const {
    ui::web::PathChunks chunks([&reader](std::string piece) { return reader.pieces->push(std::move(piece)); },
                               loaded_.machine.isMetric ? 1 : MM_PER_INCH, look_);
    std::error_code missing;  // which the reading itself tells, with its place
    if (std::filesystem::exists(path, missing) && !std::filesystem::is_regular_file(path, missing)) {
        chunks.error(path + " is no file");  // a pipe would never end
        chunks.end(0);
        return;
    }
    diag::Sink unheard;
    auto tools = machine::read_tools(loaded_.machine, unheard);
    if (!tools.has_value()) {
        chunks.error(tools.error().str());
        chunks.end(0);
        return;
    }
    machine::IniParameters ini_values(loaded_.ini, nullptr);
    machine::UnknownHalValues values(ini_values, [] {});
    gcode::PreviewMachine stand = machine::preview_stand(loaded_.machine);
    stand.interpreter.make_script_host = []() -> Result<std::unique_ptr<interp::ScriptHost>> {
        return std::make_unique<machine::UnscriptedHost>([] {});
    };
    gcode::PreviewOptions options;
    options.blocks_per_report = 256;
    gcode::Preview preview(
        std::move(stand), **tools, values, options,
        {[&chunks](std::span<const gcode::PreviewEvent> events) { static_cast<void>(chunks.take(events)); },
         [&reader](const gcode::PreviewProgress &) { return !reader.pieces->isCancelled(); }});
    diag::Sink errors([&](const diag::Diagnostic &one) {
        if (one.severity == diag::Severity::ERROR) {
            preview.flush();  // what comes before it
            chunks.error(one.what.str());
        }
    });
    static_cast<void>(preview.run(path, errors));  // its failures have been told
    chunks.end(static_cast<std::uint32_t>(std::max(preview.place().line, 0)));
}

}  // namespace mw::app
