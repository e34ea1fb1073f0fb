// SPDX-License-Identifier: GPL-2.0-or-later
// Reads programs for the screen's picture of their path, each in a thread of its own.
#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <span>
#include <string>
#include <thread>

#include "gcode/preview.hh"
#include "machine/loaded_config.hh"
#include "ui/web/path_geometry.hh"
#include "ui/web/piece_queue.hh"
#include "ui/web/time_chunks.hh"

namespace mw::app {

/// Nothing of the shop's own is run: no Python, no HAL values. One thread.
class PathReaders {
  public:
    static constexpr std::size_t MOST = 4;

    PathReaders(const machine::LoadedConfig &loaded, ui::web::PathLook look)
        : loaded_(loaded), look_(std::move(look)) {}
    /// Ends what is read.
    ~PathReaders();
    PathReaders(const PathReaders &) = delete;
    PathReaders &operator=(const PathReaders &) = delete;

    /// The chunks of docs/api.md, while the program is read; an error when MOST are.
    Result<std::shared_ptr<ui::web::PieceQueue>> read(const std::string &path);
    /// How long its moves take, by the planner.
    Result<std::shared_ptr<ui::web::PieceQueue>> read_times(const std::string &path,
                                                            const ui::web::TimeOverrides &overrides);

  private:
    struct Reader {
        std::shared_ptr<ui::web::PieceQueue> pieces;
        std::atomic<bool> isOver{false};
        std::thread thread;
    };
    Result<std::shared_ptr<ui::web::PieceQueue>> begin(std::function<void(Reader &)> job);
    void read_all(Reader &reader, const std::string &path) const;
    void time_all(Reader &reader, const std::string &path, const ui::web::TimeOverrides &overrides) const;

    struct Hearer {
        std::function<void(std::span<const gcode::PreviewEvent>, const gcode::Preview &)> events;
        std::function<void(const std::string &)> error;
    };
    /// The line at which reading ended.
    std::uint32_t interpret(const Reader &reader, const std::string &path, const Hearer &hearer) const;

    const machine::LoadedConfig &loaded_;
    ui::web::PathLook look_;
    std::list<Reader> readers_;
};

}  // namespace mw::app
