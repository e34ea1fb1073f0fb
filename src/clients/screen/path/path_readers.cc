// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/screen/path/path_readers.hh"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/thread_priority.hh"
#include "clients/screen/path/path_chunks.hh"
#include "clients/screen/path/time_chunks.hh"
#include "clients/screen/server/descriptors.hh"
#include "gcode/analysis/time_estimate.hh"
#include "gcode/analysis/unscripted.hh"
#include "machine/config/ini_parameters.hh"
#include "machine/config/program_analysis.hh"
#include "machine/tools/tool_data.hh"

namespace mw::screen {
namespace {

constexpr double MM_PER_INCH = 25.4;
constexpr std::size_t EVENTS_PER_CHECK = 64;

/// A program with subroutines or a filter can open files without using the reserve.
bool hasDescriptors() {
    constexpr int MOST_OF_A_PROGRAM = 16;
    const int fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    const bool free = fd >= 0 && !isReserved(fd + MOST_OF_A_PROGRAM);
    if (fd >= 0) {
        ::close(fd);
    }
    return free;
}

}  // namespace

PathReaders::~PathReaders() {
    cancel();
    for (Reader &reader : readers_) {
        reader.thread.join();
    }
}

void PathReaders::cancel() {
    for (Reader &reader : readers_) {
        reader.pieces->cancel();
    }
}

Result<std::shared_ptr<PieceQueue>> PathReaders::read(const std::string &path, const Requester &by) {
    return begin([this, path](Reader &reader) { read_all(reader, path); }, by);
}

Result<std::shared_ptr<PieceQueue>>
PathReaders::read_times(const std::string &path, const TimeOverrides &overrides, const Requester &by) {
    return begin([this, path, overrides](Reader &reader) { time_all(reader, path, overrides); }, by);
}

bool PathReaders::isToEnd(Reader &reader) const {
    timespec cpu{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &cpu);
    const double cpu_s = static_cast<double>(cpu.tv_sec) + 1e-9 * static_cast<double>(cpu.tv_nsec);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - reader.since;
    reader.late = reader.late || cpu_s > limits_.cpu_s || time.count() > limits_.time_s;
    return reader.late || reader.pieces->isCancelled();
}

std::string PathReaders::late_text(const std::string &path) const {
    return fmt::format("{}: reading takes longer than {} s ({} s of processor time) and was ended. Check the "
                       "program for wrong coordinates and feeds.",
                       path, limits_.time_s, limits_.cpu_s);
}

Result<> PathReaders::check_count(const Requester &by) const {
    const bool is_viewer = by.role <= Role::VIEW;
    std::size_t of_client = 0, of_viewers = 0;
    for (const Reader &reader : readers_) {
        const bool of_viewer = reader.by.role <= Role::VIEW;
        of_viewers += of_viewer ? 1 : 0;
        of_client += of_viewer == is_viewer && reader.by.address == by.address ? 1 : 0;
    }
    if (!hasDescriptors() || readers_.size() >= MOST || (is_viewer && of_viewers >= MOST_OF_VIEWERS)) {
        return fail("too many programs are being read: try again later");
    }
    const std::size_t most = is_viewer ? MOST_OF_VIEWER : MOST_OF_CLIENT;
    return of_client < most
               ? Result<>{}
               : fail(fmt::format("{} programs are being read for this computer: try again later", most));
}

Result<std::shared_ptr<PieceQueue>> PathReaders::begin(std::function<void(Reader &)> job,
                                                       const Requester &by) {
    readers_.remove_if([](Reader &reader) {
        const bool isOver = reader.isOver.load(std::memory_order_acquire);
        if (isOver) {
            reader.thread.join();
        }
        return isOver;
    });
    if (const auto checked = check_count(by); !checked.has_value()) {
        return std::unexpected(checked.error());
    }
    Reader &reader = readers_.emplace_back();
    reader.by = by;
    reader.pieces = std::make_shared<PieceQueue>();
    reader.thread = std::thread([&reader, job = std::move(job)] {
        lower_priority();
        job(reader);
        reader.pieces->end();
        // Release: a thread that sees it may join without waiting.
        reader.isOver.store(true, std::memory_order_release);
    });
    return reader.pieces;
}

std::uint32_t PathReaders::interpret(Reader &reader, const std::string &path, const Hearer &hearer) const {
    std::error_code missing;  // reading reports this error itself, with its position
    if (std::filesystem::exists(path, missing) && !std::filesystem::is_regular_file(path, missing)) {
        hearer.error(path + " is not a file");  // reading a pipe might never end
        return 0;
    }
    diagnostics::Sink unheard;
    auto tools = machine::read_tools(loaded_.machine, unheard);
    if (!tools.has_value()) {
        hearer.error(tools.error().str());
        return 0;
    }
    machine::IniParameters ini_values(loaded_.ini, nullptr);
    gcode::UnknownHalValues values(ini_values, [] {});
    gcode::PreviewMachine stand = machine::preview_stand(loaded_.machine);
    stand.interpreter.make_script_host = []() -> Result<std::unique_ptr<gcode::ScriptHost>> {
        return std::make_unique<gcode::UnscriptedHost>([] {});
    };
    gcode::PreviewOptions options;
    options.blocks_per_report = 256;
    gcode::Preview *source = nullptr;
    gcode::Preview preview(
        std::move(stand), **tools, values, options,
        {[&](std::span<const gcode::PreviewEvent> events) { hearer.events(events, *source); },
         [this, &reader](const gcode::PreviewProgress &) { return !isToEnd(reader); }});
    source = &preview;
    diagnostics::Sink errors([&](const diagnostics::Diagnostic &one) {
        if (one.severity == diagnostics::Severity::ERROR) {
            preview.flush();  // passes on earlier events
            hearer.error(one.what.str());
        }
    });
    static_cast<void>(preview.run(path, errors));  // its failures have been reported
    return static_cast<std::uint32_t>(std::max(preview.place().line, 0));
}

void PathReaders::read_all(Reader &reader, const std::string &path) const {
    PathChunks chunks([&reader](std::string piece) { return reader.pieces->push(std::move(piece)); },
                      loaded_.machine.metric ? 1 : MM_PER_INCH, look_);
    const std::uint32_t line =
        interpret(reader, path,
                  {[&](std::span<const gcode::PreviewEvent> events, const gcode::Preview &) {
                       if (!isToEnd(reader)) {
                           static_cast<void>(chunks.take(events));
                       }
                   },
                   [&](const std::string &error) { chunks.error(error); }});
    if (reader.late) {
        chunks.error(late_text(path));
    }
    chunks.end(line);
}

/// Counts the same points as the path.
void PathReaders::time_all(Reader &reader, const std::string &path, const TimeOverrides &overrides) const {
    constexpr std::size_t SLOWEST = 30;
    TimeChunks chunks([&reader](std::string piece) { return reader.pieces->push(std::move(piece)); });
    PathChunks counted([](const std::string &) { return true; }, loaded_.machine.metric ? 1 : MM_PER_INCH,
                       look_);
    gcode::TimeEstimate estimate(
        machine::timed_machine(loaded_.machine), {overrides.feed, overrides.rapid, overrides.max_velocity},
        [&](const gcode::TimedMove &move) {
            chunks.move(static_cast<std::uint32_t>(move.id),
                        static_cast<std::uint32_t>(std::max(move.line, 0)), move.seconds, move.top_velocity);
        });
    estimate.end_when([this, &reader] { return isToEnd(reader); });
    estimate.start(machine::home_position(loaded_.machine));
    bool sound = true;
    interpret(reader, path,
              {[&](std::span<const gcode::PreviewEvent> events, const gcode::Preview &preview) {
                   for (std::size_t i = 0; i < events.size(); ++i) {
                       const gcode::PreviewEvent &event = events[i];
                       if (reader.pieces->isCancelled() || (i % EVENTS_PER_CHECK == 0 && isToEnd(reader))) {
                           return;
                       }
                       static_cast<void>(counted.take({&event, 1}));
                       estimate.set_place(preview.file(event.file), event.line,
                                          preview.section(event.section));
                       estimate.take(event, std::max(counted.count(), 1U) - 1);
                   }
               },
               [&](const std::string &error) {
                   sound = false;
                   chunks.error(error);
               }});
    if (reader.late) {
        chunks.error(late_text(path));
    }
    if (isToEnd(reader) || !sound) {
        return;  // after an error the course of the program is unknown
    }
    const gcode::TimeFigures &figures = estimate.finish(SLOWEST);
    if (isToEnd(reader)) {
        chunks.error(late_text(path));
        return;
    }
    TimeSum sum{figures.total_s, figures.cutting_s, figures.rapid_s, figures.dwell_s, figures.isComplete, {}};
    for (const gcode::SlowPlace &place : figures.slowest) {
        sum.slowest.push_back({std::filesystem::path(place.file).filename().string(), place.file == path,
                               place.line, place.lost_s, place.limit});
    }
    chunks.end(sum);
}

}  // namespace mw::screen
