// SPDX-License-Identifier: GPL-2.0-or-later
// Reads programs for the screen's picture of their path, each in a thread of its own.
#pragma once

#include <atomic>
#include <list>
#include <memory>
#include <string>
#include <thread>

#include "machine/loaded_config.hh"
#include "ui/web/path_geometry.hh"
#include "ui/web/piece_queue.hh"

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

  private:
    struct Reader {
        std::shared_ptr<ui::web::PieceQueue> pieces;
        std::atomic<bool> isOver{false};
        std::thread thread;
    };
    void read_all(Reader &reader, const std::string &path) const;

    const machine::LoadedConfig &loaded_;
    ui::web::PathLook look_;
    std::list<Reader> readers_;
};

}  // namespace mw::app
