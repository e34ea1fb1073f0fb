// SPDX-License-Identifier: GPL-2.0-or-later
// Values as bytes and back, for files that only this program reads: one list of fields serves both
// directions.
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

/// Appends each value that it is called with.
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
    /// An enumerator from 0 to `last`.
    template <class Enum>
        requires std::is_enum_v<Enum>
    void choice(const Enum &value, Enum) {
        (*this)(static_cast<std::int32_t>(value));
    }
    const std::string &bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Fills the values that it is called with, in the order of packing. After the first byte that does not fit
/// it fills nothing more.
class Unpacker {
  public:
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    template <PackedNumber T>
    void operator()(T &value) {
        if (!valid_ || rest_.size() < sizeof(T)) {
            valid_ = false;
            return;
        }
        if constexpr (std::is_same_v<T, bool>) {
            valid_ = rest_[0] == 0 || rest_[0] == 1;
            value = rest_[0] == 1;
        } else {
            std::memcpy(&value, rest_.data(), sizeof(T));
        }
        rest_.remove_prefix(sizeof(T));
    }
    void operator()(std::string &text) {
        std::uint64_t size = 0;
        (*this)(size);
        if (!valid_ || size > rest_.size()) {
            valid_ = false;
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
        valid_ = valid_ && number >= 0 && number <= static_cast<std::int32_t>(last);
        value = valid_ ? static_cast<Enum>(number) : value;
    }
    /// Marks the data as not valid.
    void spoil() { valid_ = false; }
    bool isGood() const { return valid_; }
    /// All bytes are read, and all were valid.
    bool isComplete() const { return valid_ && rest_.empty(); }
    std::size_t left() const { return rest_.size(); }

  private:
    std::string_view rest_;
    bool valid_ = true;
};

}  // namespace mw
