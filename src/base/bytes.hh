// SPDX-License-Identifier: GPL-2.0-or-later
// Values as bytes and back, for files that this program alone reads: one list of fields serves both ways.
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace mw {

/// A number of a fixed size.
template <class T>
concept PackedNumber = std::integral<T> || std::floating_point<T>;

/// Appends what it is called with.
class Packer {
  public:
    template <PackedNumber T>
    void operator()(const T &value) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, &value, sizeof(T));
        bytes_.append(bytes, sizeof(T));
    }
    void operator()(const std::string &text) {
        (*this)(static_cast<std::uint64_t>(text.size()));
        bytes_ += text;
    }
    /// One of the values from 0 to `last`.
    template <class Enum>
        requires std::is_enum_v<Enum>
    void choice(const Enum &value, Enum) {
        (*this)(static_cast<std::int32_t>(value));
    }
    const std::string &bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Fills in what it is called with, in the same order; after the first byte that does not fit nothing more.
class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    template <PackedNumber T>
    void operator()(T &value) {
        if (!isGood_ || rest_.size() < sizeof(T)) {
            isGood_ = false;
            return;
        }
        if constexpr (std::is_same_v<T, bool>) {
            isGood_ = rest_[0] == 0 || rest_[0] == 1;
            value = rest_[0] == 1;
        } else {
            std::memcpy(&value, rest_.data(), sizeof(T));
        }
        rest_.remove_prefix(sizeof(T));
    }
    void operator()(std::string &text) {
        std::uint64_t size = 0;
        (*this)(size);
        if (!isGood_ || size > rest_.size()) {
            isGood_ = false;
            return;
        }
        text.assign(rest_.substr(0, size));
        rest_.remove_prefix(size);
    }
    template <class Enum>
        requires std::is_enum_v<Enum>
    void choice(Enum &value, Enum last) {
        std::int32_t number = 0;
        (*this)(number);
        isGood_ = isGood_ && number >= 0 && number <= static_cast<std::int32_t>(last);
        value = isGood_ ? static_cast<Enum>(number) : value;
    }
    /// Something that was read cannot be.
    void spoil() { isGood_ = false; }
    bool isGood() const { return isGood_; }
    /// All is read, and nothing was wrong.
    bool isComplete() const { return isGood_ && rest_.empty(); }
    std::size_t left() const { return rest_.size(); }

  private:
    std::string_view rest_;
    bool isGood_ = true;
};

}  // namespace mw
