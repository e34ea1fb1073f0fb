// SPDX-License-Identifier: GPL-2.0-or-later
// Where a tool carousel stands and how it moves, without HAL. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::carousel {

enum class Encoding { GRAY, BINARY, BCD, INDEX, EDGE, COUNTS, SINGLE };

/// Reads the name of an encoding (its first letters are enough); false when it is none.
bool parse_encoding(const char *text, Encoding &out) noexcept;

/// The inputs of one period.
struct Sensors {
    std::uint32_t bits = 0;  ///< sense-0 is bit 0
    bool isValid = true;     ///< strobe
    std::int32_t counts = 0;
    std::int32_t scale = 100;
    std::int32_t width = 0;
    std::int32_t home_offset = 0;
};

/// The pocket in position, from the sensors.
class Position {
  public:
    Encoding encoding = Encoding::GRAY;
    int pockets = 1;
    int sense_pins = 4;
    bool isHomed = false;
    std::int32_t pocket = 0;  ///< 1 to pockets; 0: none, or not known

    bool needsHoming() const noexcept {
        return encoding == Encoding::INDEX || encoding == Encoding::EDGE || encoding == Encoding::COUNTS;
    }
    /// `direction` of the motor (1, 0, -1) tells which way a pulse counts.
    void read(const Sensors &sensors, int direction) noexcept;
    /// True when the sensors show the place to home at; the pocket there is 1.
    bool findHome(const Sensors &sensors) noexcept;
    /// The marker of the pocket is under its sensor.
    bool isOnMarker(const Sensors &sensors, std::int32_t target) const noexcept;

  private:
    std::int32_t decoded(std::uint32_t bits) const noexcept;
    void read_pulse(bool isPulse, int direction) noexcept;
    void read_counts(const Sensors &sensors) noexcept;

    bool last_pulse_ = false;
    std::int32_t home_counts_ = 0;
    std::int64_t last_way_ = 0;
};

/// The pocket asked for, folded into 1 to `pockets`.
constexpr std::int32_t folded(std::int32_t wanted, int pockets) noexcept {
    return (wanted - 1) % pockets + 1;
}

/// 1 or -1: the way with fewer pockets (forwards when equal, and always when only that is possible); 0 when
/// there.
int shortest_way(std::int32_t from, std::int32_t to, int pockets, bool isBidirectional) noexcept;

}  // namespace mw::carousel
