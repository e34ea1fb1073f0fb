// SPDX-License-Identifier: GPL-2.0-or-later
// A text of bounded length inside the object, for structures that are copied as a whole through shared
// memory.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace mw::messages {

/// At most N bytes of UTF-8. Trivially copyable.
template <std::size_t N>
struct FixedText {
    static constexpr std::size_t CAPACITY = N;
    std::uint32_t size = 0;
    char bytes[N] = {};

    FixedText() = default;
    FixedText(std::string_view text) { assign(text); }

    /// False when the text is longer; its beginning is then stored, cut between characters.
    bool assign(std::string_view text) {
        std::size_t length = std::min(text.size(), N);
        while (length < text.size() && length > 0 &&
               (static_cast<unsigned char>(text[length]) & 0xc0U) == 0x80U) {
            --length;
        }
        std::memset(bytes, 0, N);
        std::memcpy(bytes, text.data(), length);
        size = static_cast<std::uint32_t>(length);
        return length == text.size();
    }
    std::string_view view() const { return {bytes, std::min<std::size_t>(size, N)}; }
    std::string str() const { return std::string(view()); }
    bool empty() const { return size == 0; }
    bool operator==(const FixedText &other) const { return view() == other.view(); }
    bool operator==(std::string_view other) const { return view() == other; }
};

}  // namespace mw::messages
