// SPDX-License-Identifier: GPL-2.0-or-later
// The path of a program as the bytes of /api/path: flat arrays that a browser hands to its graphics as they
// are.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gcode/preview.hh"

namespace mw::ui::web {

/// Arcs become chords. One thread.
class PathChunks {
  public:
    /// Chords are at most so far from their arc. [mm]
    static constexpr double DEVIATION_MM = 0.005;
    static constexpr std::size_t POINTS_PER_CHUNK = 16384;

    /// `push` takes a chunk; false: nobody reads any more. `unit_mm`: of the machine unit.
    PathChunks(std::function<bool(std::string)> push, double unit_mm)
        : push_(std::move(push)), unit_mm_(unit_mm) {}

    /// The first ones are sent at once, later ones when a chunk is full. False: nobody reads any more.
    bool take(std::span<const gcode::PreviewEvent> events);
    void error(std::string_view text);
    /// What is left, the bounds and the end.
    void end(std::uint32_t lines);

  private:
    struct Point {
        std::array<float, 3> place{};
        std::uint32_t line = 0;
        std::uint8_t kind = 0;
    };
    void add(const gcode::PreviewEvent &event);
    void add_arc(const gcode::PreviewEvent &event);
    void add_point(const std::array<double, 3> &place, const gcode::PreviewEvent &event, std::uint8_t kind);
    bool send();

    std::function<bool(std::string)> push_;
    double unit_mm_;
    std::vector<Point> points_;
    std::uint32_t count_ = 0;  ///< points of all chunks, those that stand in two once
    bool isRead_ = true;
    std::array<float, 3> low_{}, high_{};
};

}  // namespace mw::ui::web
