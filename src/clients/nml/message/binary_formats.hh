// SPDX-License-Identifier: GPL-2.0-or-later
// Raw and XDR: numbers as bytes.
//
//   number(4)  shape(4)  bytes after this head(4)   fields
//
// Raw: each number in its own width in the format of this processor; a text or list begins with its length
// (4). XDR (RFC 4506): big endian; numbers of up to 4 bytes take 4, others 8; texts are padded to a multiple
// of 4.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>

#include "clients/nml/message/format.hh"

namespace mw::nml {

inline constexpr std::size_t BINARY_FRAME_HEAD = 12;

/// Numbers as in memory.
struct RawBytes {
    static constexpr bool IS_BIG_ENDIAN = std::endian::native == std::endian::big;
    static constexpr std::size_t ALIGNMENT = 1;
    static std::size_t width(const messages::Type &type) { return type.bytes; }
};
struct XdrBytes {
    static constexpr bool IS_BIG_ENDIAN = true;
    static constexpr std::size_t ALIGNMENT = 4;
    static std::size_t width(const messages::Type &type) { return type.bytes > 4 ? 8 : 4; }
};

/// Appends to a text of bytes.
template <class Bytes>
class BinaryWriter final : public Format {
  public:
    explicit BinaryWriter(std::string &out) : out_(out), start_(out.size()) {}
    bool isReading() const override { return false; }

    bool head(FrameHead &head) override {
        put(static_cast<std::uint32_t>(head.number), 4);
        put(head.shape, 4);
        put(0, 4);
        return true;
    }
    bool integer(const Value &value, std::int64_t &number) override {
        put(static_cast<std::uint64_t>(number), Bytes::width(value.field.type));
        return true;
    }
    bool real(const Value &, double &number) override {
        put(std::bit_cast<std::uint64_t>(number), 8);
        return true;
    }
    bool text(const Value &, std::string_view &text, std::size_t) override {
        put(text.size(), 4);
        out_ += text;
        out_.append((Bytes::ALIGNMENT - text.size() % Bytes::ALIGNMENT) % Bytes::ALIGNMENT, '\0');
        return true;
    }
    bool count(const Value &, std::uint32_t &count) override {
        put(count, 4);
        return true;
    }
    bool end() override {
        const std::size_t payload = out_.size() - start_ - BINARY_FRAME_HEAD;
        const auto bytes = bytes_of(payload, 4);
        std::copy_n(bytes.begin(), 4,
                    out_.begin() + static_cast<std::ptrdiff_t>(start_ + BINARY_FRAME_HEAD - 4));
        return true;
    }

  private:
    static std::array<char, 8> bytes_of(std::uint64_t value, std::size_t width) {
        std::array<char, 8> bytes{};
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t place = Bytes::IS_BIG_ENDIAN ? width - 1 - i : i;
            bytes[place] = static_cast<char>(value >> (8 * i));
        }
        return bytes;
    }
    void put(std::uint64_t value, std::size_t width) { out_.append(bytes_of(value, width).data(), width); }

    std::string &out_;
    std::size_t start_;
};

/// Reads from the front of bytes, which are not moved.
template <class Bytes>
class BinaryReader final : public Format {
  public:
    explicit BinaryReader(std::string_view bytes) : bytes_(bytes) {}
    bool isReading() const override { return true; }

    bool head(FrameHead &head) override {
        std::uint64_t number = 0, shape = 0, payload = 0;
        if (!take(number, 4) || !take(shape, 4) || !take(payload, 4)) {
            return refuse("the bytes are too few for a message");
        }
        if (payload != bytes_.size()) {
            return refuse(fmt::format("the message says {} bytes, has {}", payload, bytes_.size()));
        }
        head.number = static_cast<std::int32_t>(number);
        head.shape = static_cast<std::uint32_t>(shape);
        return true;
    }
    bool integer(const Value &value, std::int64_t &number) override {
        const std::size_t width = Bytes::width(value.field.type);
        std::uint64_t bits = 0;
        if (!take(bits, width)) {
            return cut();
        }
        const bool isNegative = value.field.type.kind == messages::Kind::INTEGER && width < 8 &&
                                ((bits >> (8 * width - 1)) & 1U) != 0;
        number = static_cast<std::int64_t>(isNegative ? bits | (~std::uint64_t{0} << (8 * width)) : bits);
        return true;
    }
    bool real(const Value &, double &number) override {
        std::uint64_t bits = 0;
        if (!take(bits, 8)) {
            return cut();
        }
        number = std::bit_cast<double>(bits);
        return true;
    }
    bool text(const Value &, std::string_view &text, std::size_t longest) override {
        std::uint64_t size = 0;
        if (!take(size, 4)) {
            return cut();
        }
        const std::size_t filled = (size + Bytes::ALIGNMENT - 1) / Bytes::ALIGNMENT * Bytes::ALIGNMENT;
        if (size > longest) {
            return refuse(fmt::format("{} bytes are longer than it may be", size));
        }
        if (filled > bytes_.size()) {
            return cut();
        }
        text = bytes_.substr(0, size);
        if (bytes_.substr(size, filled - size).find_first_not_of('\0') != std::string_view::npos) {
            return refuse("the bytes that fill it up are not zero");
        }
        bytes_.remove_prefix(filled);
        return true;
    }
    bool count(const Value &, std::uint32_t &count) override {
        std::uint64_t number = 0;
        if (!take(number, 4) || number > bytes_.size()) {  // each entry has at least one byte
            return cut();
        }
        count = static_cast<std::uint32_t>(number);
        return true;
    }
    bool end() override { return bytes_.empty() || refuse(fmt::format("{} bytes too many", bytes_.size())); }

  private:
    bool cut() { return refuse("the message ends within it"); }
    bool take(std::uint64_t &value, std::size_t width) {
        if (width > bytes_.size()) {
            return false;
        }
        value = 0;
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t place = Bytes::IS_BIG_ENDIAN ? width - 1 - i : i;
            value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes_[place])) << (8 * i);
        }
        bytes_.remove_prefix(width);
        return true;
    }

    std::string_view bytes_;
};

using RawWriter = BinaryWriter<RawBytes>;
using RawReader = BinaryReader<RawBytes>;
using XdrWriter = BinaryWriter<XdrBytes>;
using XdrReader = BinaryReader<XdrBytes>;

}  // namespace mw::nml
