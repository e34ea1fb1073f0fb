// SPDX-License-Identifier: GPL-2.0-or-later
// The path of a program as the bytes of /api/path: flat arrays that a browser passes to its graphics
// unchanged.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "clients/screen/path/path_geometry.hh"
#include "gcode/analysis/preview.hh"

namespace mw::screen {

/// Arcs are converted to chords. All calls come from one thread.
class PathChunks {
  public:
    /// Maximum distance of chords from their arc. [mm]
    static constexpr double DEVIATION_MM = 0.005;
    static constexpr std::size_t POINTS_PER_CHUNK = 16384;

    /// `push` takes a chunk; false if the reader has left. `unit_mm` is that of the machine unit.
    PathChunks(std::function<bool(std::string)> push, double unit_mm, PathLook look = {})
        : push_(std::move(push)), unit_mm_(unit_mm), look_(std::move(look)) {}

    /// Takes events. The first ones are sent at once, later ones when a chunk is full. False if the reader
    /// has left.
    bool take(std::span<const gcode::PreviewEvent> events);
    void error(std::string_view text);
    /// Sends the rest, the bounds and the end.
    void end(std::uint32_t lines);
    /// Number of points in all chunks so far; points in two chunks are counted once.
    std::uint32_t count() const { return count_; }

  private:
    struct Point {
        std::array<float, 3> place{};
        std::array<float, 3> wire{};  ///< foam cutter: the other end
        std::uint32_t line = 0;
        std::uint8_t kind = 0;
    };
    /// Values that apply from a point on.
    struct Range {
        std::uint32_t first = 0;
        float feed = 0;
        std::uint32_t tool = 0;
    };
    /// Tool offset that applies from a point on. [machine units]
    struct ToolOffset {
        std::uint32_t first = 0;
        std::array<float, 3> xyz{};
    };
    void add(const gcode::PreviewEvent &event);
    void add_straight(const gcode::PreviewEvent &event, const geometry::Pose &from, const geometry::Pose &to,
                      std::uint8_t kind);
    void add_arc(const gcode::PreviewEvent &event);
    void add_point(const geometry::Pose &pose, const gcode::PreviewEvent &event, std::uint8_t kind);
    void note_range(const gcode::PreviewEvent &event, std::uint8_t kind);
    void note_offset(const gcode::PreviewEvent &event);
    void note_rotary(const gcode::PreviewEvent &event);
    std::string offsets() const;
    bool send();
    std::string moves(bool of_wire) const;

    std::function<bool(std::string)> push_;
    double unit_mm_;
    PathLook look_;
    std::vector<Point> points_;
    std::vector<Range> ranges_;        ///< the current range, and ranges that have not been sent
    std::size_t unsent_ = 0;           ///< number of unsent ranges, at the end
    Range range_;                      ///< current range
    std::vector<ToolOffset> offsets_;  ///< not sent yet
    std::array<float, 3> offset_{};    ///< active
    std::optional<std::uint32_t> rotary_line_;
    bool has_sent_rotary_ = false;
    std::uint32_t count_ = 0;
    bool is_read_ = true;
    bool bounded_ = false;
    std::array<float, 3> low_{}, high_{};
};

}  // namespace mw::screen
