// SPDX-License-Identifier: GPL-2.0-or-later
// Messages as bytes: little endian, versioned, with their length.
//
//   'M' 'W' version(1) 0   number(u16)  payload bytes(u32)   payload
//
// The payload contains the fields in the order of their declaration: numbers in their own width, a bool and
// the small enumerations as one byte, a text as u32 length and bytes, an array as its elements, a list as u32
// count and elements.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "base/result.hh"
#include "messages/declarations/describe.hh"

namespace mw::messages {

inline constexpr unsigned char BINARY_VERSION = 1;
inline constexpr std::size_t BINARY_HEAD = 10;

/// Appends the message to `bytes`.
void encode(const ConstObject &message, std::string &bytes);

/// Head of a message: its number and length.
struct BinaryHead {
    int number = 0;
    std::size_t payload = 0;
};
/// Reads the head. An error when the bytes are not the head of a message of this version.
Result<BinaryHead> read_head(std::string_view bytes);

/// Reads exactly one message of this declaration; each read is checked against the length, lists and texts
/// against their range before memory is allocated. After an error the object may be partly written.
Result<> decode(std::string_view bytes, const Object &message);

}  // namespace mw::messages
