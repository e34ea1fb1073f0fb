// SPDX-License-Identifier: GPL-2.0-or-later
// Reads programs for the screen's picture of their path, each in a separate thread.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "clients/screen/http/http_types.hh"
#include "clients/screen/http/piece_queue.hh"
#include "clients/screen/path/path_geometry.hh"
#include "clients/screen/path/time_chunks.hh"
#include "gcode/analysis/preview.hh"
#include "machine/config/loaded_config.hh"

namespace mw::screen {

/// Runs no Python and reads no HAL values. All calls come from one thread.
class PathReaders {
  public:
    /// Maximum number of programs read at a time: total, per client, and for the role VIEW per client and
    /// total.
    static constexpr std::size_t MOST = 8, MOST_OF_CLIENT = 4, MOST_OF_VIEWER = 2, MOST_OF_VIEWERS = 4;

    /// Limits for reading one program.
    struct Limits {
        double cpu_s = 300, time_s = 900;
    };

    PathReaders(const machine::LoadedConfig &loaded, PathLook look)
        : PathReaders(loaded, std::move(look), Limits{}) {}
    PathReaders(const machine::LoadedConfig &loaded, PathLook look, const Limits &limits)
        : loaded_(loaded), look_(std::move(look)), limits_(limits) {}
    /// Cancels all readers.
    ~PathReaders();
    PathReaders(const PathReaders &) = delete;
    PathReaders &operator=(const PathReaders &) = delete;

    /// The chunks of docs/reference/api.md, while the program is read; an error when too many are being read.
    Result<std::shared_ptr<PieceQueue>> read(const std::string &path, const Requester &by = {});
    /// Another job that produces pieces; it counts as a reader.
    Result<std::shared_ptr<PieceQueue>> run(std::function<void(PieceQueue &)> job, const Requester &by = {}) {
        return begin([job = std::move(job)](Reader &reader) { job(*reader.pieces); }, by);
    }
    /// Times of the program's moves, from the planner.
    Result<std::shared_ptr<PieceQueue>> read_times(const std::string &path, const TimeOverrides &overrides,
                                                   const Requester &by = {});
    /// Requests all readers to end.
    void cancel();

  private:
    struct Reader {
        std::shared_ptr<PieceQueue> pieces;
        Requester by;
        std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
        std::atomic<bool> isOver{false};
        bool late = false;  ///< [its thread] a limit has ended it
        std::thread thread;
    };
    Result<> check_count(const Requester &by) const;
    Result<std::shared_ptr<PieceQueue>> begin(std::function<void(Reader &)> job, const Requester &by);
    /// True if it has no receiver, or a limit is exceeded. [its thread]
    bool isToEnd(Reader &reader) const;
    std::string late_text(const std::string &path) const;
    void read_all(Reader &reader, const std::string &path) const;
    void time_all(Reader &reader, const std::string &path, const TimeOverrides &overrides) const;

    struct Hearer {
        std::function<void(std::span<const gcode::PreviewEvent>, const gcode::Preview &)> events;
        std::function<void(const std::string &)> error;
    };
    /// The line at which reading ended.
    std::uint32_t interpret(Reader &reader, const std::string &path, const Hearer &hearer) const;

    const machine::LoadedConfig &loaded_;
    PathLook look_;
    Limits limits_;
    std::list<Reader> readers_;
};

}  // namespace mw::screen
