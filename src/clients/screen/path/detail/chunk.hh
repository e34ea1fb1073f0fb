// SPDX-License-Identifier: GPL-2.0-or-later
// Chunks of the streams of docs/reference/api.md.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>

namespace mw::screen::detail {

static_assert(std::endian::native == std::endian::little, "chunks are little-endian");

enum class Chunk : std::uint32_t {
    MOVES = 1,
    BOUNDS = 2,
    END = 3,
    ERROR = 4,
    RANGES = 5,
    WIRES = 6,
    TIMES = 7,
    TIME_SUM = 8,
    OFFSETS = 9,
    ROTARY = 10
};

template <class T>
void append(std::string &bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
}

/// A chunk with its head, padded to whole words.
inline std::string chunk(Chunk kind, std::string body, char padding) {
    constexpr std::size_t WORD = 4;
    body.append((WORD - body.size() % WORD) % WORD, padding);
    std::string bytes;
    append(bytes, static_cast<std::uint32_t>(kind));
    append(bytes, static_cast<std::uint32_t>(body.size()));
    return bytes + body;
}

}  // namespace mw::screen::detail
