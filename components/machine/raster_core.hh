// SPDX-License-Identifier: GPL-2.0-or-later
// One line of pixels for a laser, read from bytes of any source. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::raster {

constexpr int MAX_PIXELS = 32768;
constexpr int MAX_HEADER = 96;

enum class Reading : std::uint8_t { NOTHING, HEADER, PIXELS, COMPLETE, BAD_HEADER, BAD_PIXEL };

/// "OFFSET;BITS;PPU;COUNT", a newline, and COUNT pixels of BITS / 4 hexadecimal digits.
class Line {
  public:
    /// Takes the next byte; at COMPLETE and mistakes it takes none until `clear`.
    void take(char byte) noexcept;
    void clear() noexcept { reading_ = Reading::NOTHING; }
    Reading reading() const noexcept { return reading_; }

    double offset() const noexcept { return offset_; }  ///< from the start to the first pixel [units]
    double pixels_per_unit() const noexcept { return per_unit_; }  ///< not 0
    int count() const noexcept { return count_; }
    /// 0 to count - 1.
    std::uint16_t pixel(int index) const noexcept { return pixel_[index]; }
    /// The largest value of a pixel.
    unsigned full_scale() const noexcept { return (1U << (4U * static_cast<unsigned>(digits_))) - 1U; }

  private:
    void take_header(char byte) noexcept;
    void take_pixel(char byte) noexcept;
    bool parse_header() noexcept;

    Reading reading_ = Reading::NOTHING;
    char header_[MAX_HEADER] = {};
    int header_size_ = 0;
    double offset_ = 0.0;
    double per_unit_ = 1.0;
    int digits_ = 2;
    int count_ = 0;
    int pixels_ = 0;
    int digit_ = 0;
    std::uint16_t pixel_[MAX_PIXELS] = {};
};

}  // namespace mw::raster
