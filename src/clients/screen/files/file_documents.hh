// SPDX-License-Identifier: GPL-2.0-or-later
// The JSON documents of files: list of programs, MDI lines, offsets, preferences.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mw::screen {

std::string lines_document(std::span<const std::string> lines);
/// Reads {"lines": [...]}; nothing if the text has another form or more than `most` lines.
std::optional<std::vector<std::string>> read_lines(std::string_view text, std::size_t most);
bool isObject(std::string_view json);
/// Nine offsets and the rotation [deg] of each coordinate system.
std::string offsets_document(std::span<const std::array<double, 10>> systems);

struct FileFacts {
    std::string name;
    std::uint64_t size = 0;
    std::int64_t modified_s = 0;  ///< seconds since 1970
};
std::string files_document(std::span<const FileFacts> files);

}  // namespace mw::screen
