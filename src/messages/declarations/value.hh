// SPDX-License-Identifier: GPL-2.0-or-later
// Reads and writes single values of a declared struct, without its type.
#pragma once

#include <cstdint>
#include <string_view>

#include "messages/declarations/describe.hh"

namespace mw::messages {

/// Number of elements of the field at `at`; 1 if it is not an array or list.
std::size_t count_elements(const Type &type, const void *at);
const void *element(const Type &type, const void *at, std::size_t index);
void *element(const Type &type, void *at, std::size_t index);
bool isSeries(const Type &type);

/// Value of a BOOL, INTEGER, UNSIGNED or NAMED. An UNSIGNED of 8 bytes is returned as its bits.
std::int64_t get_integer(const Type &type, const void *at);
void set_integer(const Type &type, void *at, std::int64_t value);
/// True if the value fits the type: its bytes, 0 or 1, a known name.
bool isRepresentable(const Type &type, std::int64_t value);
double get_real(const void *at);
void set_real(void *at, double value);
std::string_view get_text(const Type &type, const void *at);
/// False when the text is too long for the type; then nothing changes.
bool set_text(const Type &type, void *at, std::string_view text);
/// Name of a value; null when the enumeration has no such value.
const char *name_of(const Type &type, std::int64_t value);
/// Maximum length of a text in the field. [bytes]
std::size_t longest_text(const Field &field);

}  // namespace mw::messages
