// SPDX-License-Identifier: GPL-2.0-or-later
// Arbitrary bytes as a line of pixels and as the format of a display.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include "components/hmi/lcd_core.hh"
#include "components/machine/carousel_core.hh"
#include "components/machine/raster_core.hh"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string text(reinterpret_cast<const char *>(data), size);
    const auto line = std::make_unique<mw::raster::Line>();
    for (const char byte : text) {
        line->take(byte);
    }
    if (line->reading() == mw::raster::Reading::COMPLETE) {
        const bool isGood = line->count() >= 1 && line->pixels_per_unit() != 0.0 &&
                            std::isfinite(line->offset()) &&
                            line->pixel(line->count() - 1) <= line->full_scale();
        if (!isGood) {
            std::abort();
        }
    }
    const char *rest = text.c_str();
    mw::lcd::Item item;
    while (*rest != '\0' && mw::lcd::parse_item(rest, item)) {
        const mw::lcd::Text shown[] = {
            mw::lcd::show_float(item, static_cast<double>(size) * 1e3 - 7e3, '.'),
            mw::lcd::show_integer(item, static_cast<std::uint32_t>(size) * 2654435761U, size % 2 == 0),
            mw::lcd::show_character(item, data[0])};
        for (const mw::lcd::Text &field : shown) {
            if (field.length < 0 || field.length > static_cast<int>(sizeof field.text)) {
                std::abort();
            }
        }
    }
    mw::carousel::Encoding encoding = mw::carousel::Encoding::GRAY;
    (void)mw::carousel::parse_encoding(text.c_str(), encoding);
    return 0;
}
