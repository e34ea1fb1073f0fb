// SPDX-License-Identifier: GPL-2.0-or-later
// Reads programs for the screen's picture of their path, each in a thread of its own.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "gcode/preview.hh"
#include "machine/loaded_config.hh"
#include "ui/web/exchange.hh"
#include "ui/web/path_geometry.hh"
#include "ui/web/piece_queue.hh"
#include "ui/web/time_chunks.hh"

namespace mw::app {

/// Nothing of the shop's own is run: no Python, no HAL values. One thread.
class PathReaders {
  public:
    /// Programs that are read at a time: in all, of one client, and by the role VIEW of one client and in
    /// all.
    static constexpr std::size_t MOST = 8, MOST_OF_CLIENT = 4, MOST_OF_VIEWER = 2, MOST_OF_VIEWERS = 4;

    /// Of reading one program.
    struct Limits {
        double cpu_s = 300, time_s = 900;
    };

    PathReaders(const machine::LoadedConfig &loaded, ui::web::PathLook look)
        : PathReaders(loaded, std::move(look), Limits{}) {}
    PathReaders(const machine::LoadedConfig &loaded, ui::web::PathLook look, const Limits &limits)
        : loaded_(loaded), look_(std::move(look)), limits_(limits) {}
    /// Ends what is read.
    ~PathReaders();
    PathReaders(const PathReaders &) = delete;
    PathReaders &operator=(const PathReaders &) = delete;

    /// The chunks of docs/api.md, while the program is read; an error when too many are.
    Result<std::shared_ptr<ui::web::PieceQueue>> read(const std::string &path,
                                                      const ui::web::Requester &by = {});
    /// Another job that makes pieces, counted as a program that is read.
    Result<std::shared_ptr<ui::web::PieceQueue>> run(std::function<void(ui::web::PieceQueue &)> job,
                                                     const ui::web::Requester &by = {}) {
        return begin([job = std::move(job)](Reader &reader) { job(*reader.pieces); }, by);
    }
    /// How long its moves take, by the planner.
    Result<std::shared_ptr<ui::web::PieceQueue>> read_times(const std::string &path,
                                                            const ui::web::TimeOverrides &overrides,
                                                            const ui::web::Requester &by = {});
    /// Ends all that is read, soon.
    void cancel();

  private:
    struct Reader {
        std::shared_ptr<ui::web::PieceQueue> pieces;
        ui::web::Requester by;
        std::chrono::steady_clock::time_point since = std::chrono::steady_clock::now();
        std::atomic<bool> isOver{false};
        bool isLate = false;  ///< [its thread] a limit has ended it
        std::thread thread;
    };
    Result<> check_count(const ui::web::Requester &by) const;
    Result<std::shared_ptr<ui::web::PieceQueue>> begin(std::function<void(Reader &)> job,
                                                       const ui::web::Requester &by);
    /// Nobody waits for it any more, or a limit is exceeded. [its thread]
    bool isToEnd(Reader &reader) const;
    std::string late_text(const std::string &path) const;
    void read_all(Reader &reader, const std::string &path) const;
    void time_all(Reader &reader, const std::string &path, const ui::web::TimeOverrides &overrides) const;

    struct Hearer {
        std::function<void(std::span<const gcode::PreviewEvent>, const gcode::Preview &)> events;
        std::function<void(const std::string &)> error;
    };
    /// The line at which reading ended.
    std::uint32_t interpret(Reader &reader, const std::string &path, const Hearer &hearer) const;

    const machine::LoadedConfig &loaded_;
    ui::web::PathLook look_;
    Limits limits_;
    std::list<Reader> readers_;
};

}  // namespace mw::app
