// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/temporary_folder.hh"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/core.h>

namespace mw::halcompile {

Result<TemporaryFolder> TemporaryFolder::make() {
    const char *base = std::getenv("TMPDIR");
    std::string path = fmt::format("{}/halcompile-XXXXXX", base == nullptr || *base == '\0' ? "/tmp" : base);
    if (::mkdtemp(path.data()) == nullptr) {
        return fail(fmt::format("cannot make the folder {}: {}", path, std::strerror(errno)));
    }
    return TemporaryFolder(path);
}

TemporaryFolder::~TemporaryFolder() {
    if (!path_.empty()) {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
}

}  // namespace mw::halcompile
