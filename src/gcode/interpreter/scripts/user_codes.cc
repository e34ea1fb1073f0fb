// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/scripts/user_codes.hh"

#include <unistd.h>

#include <filesystem>

#include <fmt/format.h>

namespace mw::gcode {

std::string find_user_program(const std::vector<std::string> &folders, int code) {
    for (const std::string &folder : folders) {
        const std::filesystem::path path = std::filesystem::path(folder) / fmt::format("M{}", code);
        std::error_code ignored;
        if (std::filesystem::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0) {
            return path.string();
        }
    }
    return {};
}

}  // namespace mw::gcode
