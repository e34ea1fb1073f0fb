// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/whole_path.hh"

#include <filesystem>

namespace mw {

std::string whole_path(const std::string &path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path given(path);
    if (!fs::exists(given, error)) {
        return path;
    }
    if (!fs::is_symlink(given, error) || !given.has_filename()) {
        const auto whole = fs::canonical(given, error);
        return error ? path : whole.string();
    }
    const auto folder = fs::canonical(given.has_parent_path() ? given.parent_path() : ".", error);
    return error ? path : (folder / given.filename()).string();
}

}  // namespace mw
