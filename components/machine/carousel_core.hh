// SPDX-License-Identifier: GPL-2.0-or-later
// The position and movement of a tool carousel, without HAL. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::carousel {

enum class Encoding { GRAY, BINARY, BCD, INDEX, EDGE, COUNTS, SINGLE };

/// Reads the name of an encoding (its first letters are enough). False when the name is unknown.
bool parse_encoding(const char *text, Encoding &out) noexcept;

/// The inputs in one period.
struct Sensors {
    std::uint32_t bits = 0;  ///< sense-0 is bit 0
    bool valid = true;       ///< strobe
    std::int32_t counts = 0;
    std::int32_t scale = 100;
    std::int32_t width = 0;
    std::int32_t home_offset = 0;
};

/// Finds the pocket in position from the sensors.
class Position {
  public:
    Encoding encoding = Encoding::GRAY;
    int pockets = 1;
    int sense_pins = 4;
    bool isHomed = false;
    std::int32_t pocket = 0;  ///< 1 to pockets; 0: none, or unknown

    bool needsHoming() const noexcept {
        return encoding == Encoding::INDEX || encoding == Encoding::EDGE || encoding == Encoding::COUNTS;
    }
    /// `direction` of the motor (1, 0, -1) decides whether a pulse counts up or down.
    void read(const Sensors &sensors, int direction) noexcept;
    /// True when the sensors show the home position; the pocket there becomes 1.
    bool findHome(const Sensors &sensors) noexcept;
    /// The marker of the pocket is under its sensor.
    bool isOnMarker(const Sensors &sensors, std::int32_t target) const noexcept;

  private:
    std::int32_t decoded(std::uint32_t bits) const noexcept;
    void read_pulse(bool is_pulse, int direction) noexcept;
    void read_counts(const Sensors &sensors) noexcept;

    bool last_pulse_ = false;
    std::int32_t home_counts_ = 0;
    std::int64_t last_way_ = 0;
};

/// The requested pocket, wrapped into 1 to `pockets`.
constexpr std::int32_t folded(std::int32_t wanted, int pockets) noexcept {
    return (wanted - 1) % pockets + 1;
}

/// 1 or -1: the direction with fewer pockets to pass (forwards when equal, and always when only forwards is
/// possible). 0 when already there.
int shortest_way(std::int32_t from, std::int32_t to, int pockets, bool bidirectional) noexcept;

}  // namespace mw::carousel
