// SPDX-License-Identifier: GPL-2.0-or-later
#include "components/machine/carousel_core.hh"

#include "components/logic/gray.hh"

namespace mw::carousel {

bool parse_encoding(const char *text, Encoding &out) noexcept {
    struct Named {
        const char *name;
        Encoding encoding;
    };
    constexpr Named NAMES[] = {{"gray", Encoding::GRAY},    {"binary", Encoding::BINARY},
                               {"bcd", Encoding::BCD},      {"index", Encoding::INDEX},
                               {"edge", Encoding::EDGE},    {"counts", Encoding::COUNTS},
                               {"single", Encoding::SINGLE}};
    for (const Named &known : NAMES) {
        int i = 0;
        while (text[i] != '\0' && (text[i] | 0x20) == known.name[i]) {
            ++i;
        }
        if (text[i] == '\0' && i > 0) {
            out = known.encoding;
            return true;
        }
    }
    return false;
}

std::int32_t Position::decoded(std::uint32_t bits) const noexcept {
    switch (encoding) {
    case Encoding::GRAY: return static_cast<std::int32_t>(logic::binary_of_gray(bits));
    case Encoding::BCD: return static_cast<std::int32_t>((bits >> 4 & 15U) * 10 + (bits & 15U));
    case Encoding::SINGLE: {
        const bool is_one = bits != 0 && (bits & (bits - 1)) == 0;
        return is_one ? __builtin_ctz(bits) + 1 : 0;
    }
    default: return static_cast<std::int32_t>(bits);
    }
}

void Position::read_pulse(bool is_pulse, int direction) noexcept {
    const bool counted = encoding == Encoding::EDGE ? is_pulse != last_pulse_ : is_pulse && !last_pulse_;
    last_pulse_ = is_pulse;
    if (counted && isHomed && direction != 0) {
        pocket = (pocket - 1 + direction + pockets) % pockets + 1;
    }
}

/// A pocket is in position when it is near its centre, or when its centre was passed since the last period.
void Position::read_counts(const Sensors &sensors) noexcept {
    const std::int64_t scale = sensors.scale > 0 ? sensors.scale : 1;
    const std::int64_t way = std::int64_t{sensors.counts} - home_counts_ - sensors.home_offset;
    const auto floor_of = [scale](std::int64_t at) {
        return at >= 0 ? at / scale : -((-at + scale - 1) / scale);
    };
    const std::int64_t nearest = floor_of(way + scale / 2);
    std::int64_t distance = way - nearest * scale;
    distance = distance < 0 ? -distance : distance;
    std::int64_t place = 0;
    if (distance <= sensors.width) {
        place = nearest;
    } else if (floor_of(way) != floor_of(last_way_)) {
        place = way > last_way_ ? floor_of(way) : floor_of(way) + 1;
    } else {
        last_way_ = way;
        return;
    }
    last_way_ = way;
    if (isHomed) {
        pocket = static_cast<std::int32_t>((place % pockets + pockets) % pockets) + 1;
    }
}

void Position::read(const Sensors &sensors, int direction) noexcept {
    if (!sensors.valid) {
        return;
    }
    if (encoding == Encoding::COUNTS) {
        read_counts(sensors);
    } else if (needsHoming()) {
        read_pulse((sensors.bits & 2U) != 0, direction);
    } else {
        pocket = decoded(sensors.bits);
    }
}

bool Position::findHome(const Sensors &sensors) noexcept {
    const std::uint32_t wanted = encoding == Encoding::COUNTS ? 1U : 3U;
    if ((sensors.bits & wanted) != wanted) {
        return false;
    }
    isHomed = true;
    pocket = 1;
    last_pulse_ = true;
    home_counts_ = sensors.counts;
    last_way_ = -std::int64_t{sensors.home_offset};
    return true;
}

bool Position::isOnMarker(const Sensors &sensors, std::int32_t target) const noexcept {
    const bool has_pulse = encoding == Encoding::INDEX || encoding == Encoding::EDGE;
    return has_pulse ? (sensors.bits & 2U) != 0 : pocket == target;
}

int shortest_way(std::int32_t from, std::int32_t to, int pockets, bool bidirectional) noexcept {
    if (from == to) {
        return 0;
    }
    const std::int32_t forwards = ((to - from) % pockets + pockets) % pockets;
    return !bidirectional || 2 * forwards <= pockets ? 1 : -1;
}

}  // namespace mw::carousel
