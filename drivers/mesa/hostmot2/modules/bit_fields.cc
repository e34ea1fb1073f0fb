// SPDX-License-Identifier: GPL-2.0-or-later
#include "drivers/mesa/hostmot2/modules/bit_fields.hh"

#include <algorithm>

namespace mw::mesa {

namespace {

constexpr int BITS_PER_WORD = 32;

std::uint64_t mask_of(int bits) noexcept {
    return bits >= MAX_FIELD_BITS ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1;
}

std::uint64_t from_gray(std::uint64_t value) noexcept {
    for (unsigned shift = 1; shift < MAX_FIELD_BITS; shift *= 2) {
        value ^= value >> shift;
    }
    return value;
}

}  // namespace

std::uint64_t bits_of(const BitField &field, std::span<const std::uint32_t> words) noexcept {
    std::uint64_t value = 0;
    for (int done = 0; done < field.bits;) {
        const auto word = static_cast<std::size_t>((field.first + done) / BITS_PER_WORD);
        const int shift = (field.first + done) % BITS_PER_WORD;
        const std::uint64_t part = word < words.size() ? words[word] >> static_cast<unsigned>(shift) : 0U;
        value |= part << static_cast<unsigned>(done);
        done += BITS_PER_WORD - shift;
    }
    value &= mask_of(field.bits);
    return field.gray ? from_gray(value) : value;
}

std::int64_t signed_bits(std::uint64_t value, int bits) noexcept {
    const auto unused = static_cast<unsigned>(MAX_FIELD_BITS - bits);
    return static_cast<std::int64_t>(value << unused) >> unused;
}

void absolute_encoder_read(AbsoluteEncoder &encoder, std::uint64_t value, const BitField &field) noexcept {
    const std::int64_t before = encoder.raw;
    const std::uint64_t change = (value - encoder.last) & mask_of(field.bits);
    if (!encoder.known || field.multi_turn) {
        encoder.raw = signed_bits(value, field.bits);
    } else {
        encoder.raw += signed_bits(change, field.bits);
    }
    const bool moved = encoder.known && encoder.raw != before;
    encoder.last = value;
    encoder.known = true;
    const auto rev = static_cast<std::int64_t>(std::max(encoder.counts_per_rev, 1U));
    const auto turn = [&](std::int64_t raw) { return raw >= 0 ? raw / rev : (raw + 1) / rev - 1; };
    if (encoder.index_enable && moved && turn(encoder.raw) != turn(before)) {
        encoder.zero = (encoder.raw > before ? turn(encoder.raw) : turn(before)) * rev;
        encoder.index_enable = false;
    }
    if (encoder.reset) {
        encoder.zero = encoder.raw;
    }
    const auto low = [](std::int64_t n) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::uint64_t>(n)));
    };
    const bool scaled = encoder.scale != 0.0 && encoder.scale - encoder.scale == 0.0;
    encoder.rawcounts = low(encoder.raw);
    encoder.count = low(encoder.raw - encoder.zero);
    encoder.position = static_cast<double>(encoder.raw - encoder.zero) / (scaled ? encoder.scale : 1.0);
}

}  // namespace mw::mesa
