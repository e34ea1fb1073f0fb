// SPDX-License-Identifier: GPL-2.0-or-later
// One line of pixels for a laser, read from bytes of any source. Realtime-safe.
#pragma once

#include <cstdint>

namespace mw::raster {

constexpr int MAX_PIXELS = 32768;
constexpr int MAX_FIELD = 32;
/// The output when there is nothing to engrave.
constexpr double NO_PIXEL = -1.0;

enum class Reading : std::uint8_t {
    NOTHING,
    HEADER,
    PIXELS,
    COMPLETE,
    BAD_OFFSET,
    BAD_BITS,
    BAD_SCALE,
    BAD_COUNT,
    BAD_PIXEL
};

/// "OFFSET;BITS;PPU;COUNT;" followed by COUNT pixels of BITS / 4 hexadecimal digits.
class Line {
  public:
    /// Takes the next byte. When the line is complete or has an error, bytes are ignored until `clear`.
    void take(char byte) noexcept;
    void clear() noexcept { reading_ = Reading::NOTHING; }
    Reading reading() const noexcept { return reading_; }

    double offset() const noexcept {
        return offset_;
    }  ///< distance from the start to the first pixel [units]
    double pixels_per_unit() const noexcept { return per_unit_; }  ///< greater than 0
    int bits() const noexcept { return 4 * digits_; }
    int count() const noexcept { return count_; }
    /// Power of pixel 0 to count - 1: 0 to 100 [%]. The second highest value is 100 %; the highest value is
    /// NO_PIXEL.
    double percent(int index) const noexcept;
    /// The position in the line, in pixels from the first one, at `from_start`. With a negative offset it
    /// runs downwards.
    double way(double from_start) const noexcept;

  private:
    void take_header(char byte) noexcept;
    void take_pixel(char byte) noexcept;
    Reading take_field() noexcept;

    Reading reading_ = Reading::NOTHING;
    char header_[MAX_FIELD] = {};  ///< the field that is being read
    int header_size_ = 0;
    int fields_ = 0;  ///< number of complete header fields
    double offset_ = 0.0;
    double per_unit_ = 1.0;
    int digits_ = 2;
    int count_ = 0;
    int pixels_ = 0;
    int digit_ = 0;
    std::uint32_t pixel_[MAX_PIXELS] = {};
};

}  // namespace mw::raster
