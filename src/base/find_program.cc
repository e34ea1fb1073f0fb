// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/find_program.hh"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace mw {
namespace {

namespace fs = std::filesystem;

bool isProgram(const fs::path &path) {
    std::error_code error;
    return fs::is_regular_file(path, error) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string find_program(const std::string &name, const std::string &folder) {
    if (name.find('/') != std::string::npos) {
        const fs::path path = fs::path(folder) / name;  // an absolute name is not changed
        return isProgram(path) ? path.string() : std::string();
    }
    const char *const path = std::getenv("PATH");
    std::istringstream folders(folder + ':' + (path != nullptr ? path : "/usr/bin:/bin"));
    std::string one;
    while (std::getline(folders, one, ':')) {
        const fs::path candidate = fs::path(one.empty() ? "." : one) / name;
        if (isProgram(candidate)) {
            std::error_code error;
            return fs::absolute(candidate, error).string();
        }
    }
    return {};
}

}  // namespace mw
